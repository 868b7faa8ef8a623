/* view/access.c: see access.h. */
#include "view/access.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>
#include <unistd.h>

bool access_make_token(char token[TOKEN_SIZE]) {
  unsigned char bytes[(TOKEN_SIZE - 1) / 2];
  if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
    return false;
  for (size_t i = 0; i < sizeof bytes; i++)
    snprintf(token + 2 * i, 3, "%02x", bytes[i]);
  return true;
}

const char *access_path(const char *path, const char *token) {
  size_t n = strlen(token);
  if (path[0] != '/' || strlen(path) < n + 2)
    return NULL;
  unsigned differs = path[n + 1] != '/'; /* in a time that does not tell how much is right */
  for (size_t i = 0; i < n; i++)
    differs |= (unsigned)(path[1 + i] ^ token[i]);
  return differs ? NULL : path + n + 2;
}

/* The name in a Host header, without port and brackets. */
static bool host_name(const char *host, char *name, size_t size) {
  const bool bracketed = host[0] == '['; /* an IPv6 address */
  const size_t n = strcspn(host, bracketed ? "]" : ":");
  const size_t skip = bracketed ? 1 : 0;
  const char *rest = host + n + (bracketed && host[n] == ']');
  if (n <= skip || n - skip >= size || (*rest && *rest != ':'))
    return false;
  if (*rest == ':' && (!rest[1] || rest[1 + strspn(rest + 1, "0123456789")]))
    return false;
  snprintf(name, size, "%.*s", (int)(n - skip), host + skip);
  return true;
}

static bool is_number(const char *name) {
  unsigned char bytes[16];
  return inet_pton(AF_INET, name, bytes) == 1 || inet_pton(AF_INET6, name, bytes) == 1;
}

bool access_host(const char *host, const char *listen) {
  char name[256], own[256] = "";
  if (!host_name(host, name, sizeof name))
    return false;
  if (strcmp(name, "127.0.0.1") == 0 || strcmp(name, "::1") == 0 ||
      strcasecmp(name, "localhost") == 0)
    return true;
  if (!listen)
    return false;
  if (strcasecmp(name, listen) == 0)
    return true;
  if (strcmp(listen, "0.0.0.0") != 0 && strcmp(listen, "::") != 0)
    return false;
  return is_number(name) ||
         (gethostname(own, sizeof own - 1) == 0 && strcasecmp(name, own) == 0);
}

bool access_origin(const char *origin, const char *host) {
  return strncmp(origin, "http://", 7) == 0 && strcasecmp(origin + 7, host) == 0;
}
