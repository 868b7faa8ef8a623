/* cli/confine.c: see confine.h. */
#include "cli/confine.h"

#include <stdio.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "velo/confine.h"

void confine_read(Confine *confine, const char *path) {
  if (path && confine->read_count < CONFINE_MAX_PATHS)
    confine->read[confine->read_count++] = path;
}

void confine_read_folder(Confine *confine, const char *path) {
  if (!path)
    return;
  confine_read(confine, path);
  if (confine->folder_count == LENGTH(confine->folders))
    return;
  char *folder = confine->folders[confine->folder_count];
  const char *slash = strrchr(path, '/');
  int n = slash ? snprintf(folder, sizeof *confine->folders, "%.*s/", (int)(slash - path), path)
                : snprintf(folder, sizeof *confine->folders, ".");
  if (n < 0 || (size_t)n >= sizeof *confine->folders)
    return;
  confine->folder_count++;
  confine_read(confine, folder);
}

void confine_write(Confine *confine, const char *path) {
  if (path && confine->write_count < CONFINE_MAX_PATHS)
    confine->write[confine->write_count++] = path;
}

void confine_apply(Confine *confine, const Arguments *arguments) {
  if (!arguments->folder_count)
    return;
  for (int i = 0; i < arguments->folder_count; i++)
    confine_read(confine, arguments->folders[i]);
  const vlConfined done = vl_confine(confine->read, confine->read_count, confine->write,
                                     confine->write_count, confine->sockets);
  const char *network = done.network
                            ? confine->listens ? "no network but the page" : "no network"
                        : confine->sockets ? "network open for --serve"
                                           : "network open";
  if (done.files || done.network || done.programs)
    report_note("--sandbox: the system confines velo: %s, %s, %s",
                done.files ? "files by folder" : "files by their names only (no Landlock)",
                network, done.programs ? "no other programs" : "other programs possible");
  else
    report_note(
        "--sandbox: this system cannot confine velo; it checks the names of files itself");
}
