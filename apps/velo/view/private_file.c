/* view/private_file.c: see private_file.h. */
#include "view/private_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/macros.h"

/* Whether it belongs to this user, and nobody else may do anything with it. */
static bool is_private(const struct stat *about) {
  return about->st_uid == geteuid() && (about->st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

static bool folder_is_private(const char *path) {
  struct stat about;
  return lstat(path, &about) == 0 && S_ISDIR(about.st_mode) && is_private(&about);
}

/* False: there is none. */
static bool find_folder(char path[PRIVATE_PATH]) {
  const char *given = getenv("XDG_RUNTIME_DIR"), *temporary = getenv("TMPDIR");
  if (given && given[0] == '/' && strlen(given) < PRIVATE_PATH && folder_is_private(given)) {
    strcpy(path, given);
    return true;
  }
  if (!temporary || temporary[0] != '/')
    temporary = "/tmp";
  int size = snprintf(path, PRIVATE_PATH, "%s/velo-%lu", temporary, (unsigned long)geteuid());
  return size < PRIVATE_PATH && (mkdir(path, S_IRWXU) == 0 || errno == EEXIST) &&
         folder_is_private(path);
}

FILE *private_file_make(char path[PRIVATE_PATH]) {
  char folder[PRIVATE_PATH];
  if (!find_folder(folder))
    return NULL;
  int size = snprintf(path, PRIVATE_PATH, "%s/velo-view-XXXXXX.html", folder);
  int fd = size < PRIVATE_PATH ? mkostemps(path, (int)strlen(".html"), O_CLOEXEC) : -1;
  FILE *out = fd < 0 ? NULL : fdopen(fd, "w");
  if (fd >= 0 && !out) {
    close(fd);
    unlink(path);
  }
  return out;
}

static bool is_token(const char *text, size_t size) {
  return size == TOKEN_SIZE - 1 && strspn(text, "0123456789abcdef") == TOKEN_SIZE - 1;
}

void private_file_token(int port, char token[TOKEN_SIZE]) {
  char folder[PRIVATE_PATH], path[PRIVATE_PATH], kept[TOKEN_SIZE] = "";
  struct stat about;
  if (!find_folder(folder) ||
      text_set(path, "%s/velo-view-%d.token", folder, port) >= PRIVATE_PATH)
    return;
  int fd = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0)
    return;
  if (fstat(fd, &about) == 0 && S_ISREG(about.st_mode) && is_private(&about)) {
    ssize_t size = read(fd, kept, TOKEN_SIZE - 1);
    if (size > 0 && is_token(kept, (size_t)size)) {
      strcpy(token, kept);
    } else if (ftruncate(fd, 0) != 0 ||
               pwrite(fd, token, TOKEN_SIZE - 1, 0) != TOKEN_SIZE - 1) {
      unlink(path);
    }
  }
  close(fd);
}
