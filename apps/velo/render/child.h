/* render/child.h: another program as a child process, started without a shell, in a process
 * group of its own, so that a Ctrl-C at the terminal reaches velo alone. What it writes to its
 * standard error is kept, for the line that says why it failed. */
#ifndef APP_RENDER_CHILD_H
#define APP_RENDER_CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

enum {
  CHILD_WAIT = 50,     /* milliseconds between two looks for a signal to velo */
  CHILD_MAX_WORDS = 64 /* arguments of a program, with the null behind them */
};

typedef struct Child {
  pid_t id;
  int input;      /* the pipe to its standard input, not blocking; -1: closed */
  FILE *messages; /* its standard error; null: not kept */
} Child;

/* Which line of its standard error explains a failure. */
typedef enum ChildLine { CHILD_FIRST_LINE, CHILD_LAST_LINE } ChildLine;

/* Looks for a program in the folders of a list like PATH; those that are no absolute paths are
 * left out. False: it is not there. */
bool child_find(const char *folders, const char *name, char *program, size_t size);
/* Starts a program; words: its arguments, the first its name, a null last; at most
 * CHILD_MAX_WORDS. output, further: its descriptors 1 and 3; -1: none. Returns 0, or the number
 * of the system's error. */
int child_start(Child *child, const char *program, const char *const *words, int output,
                int further);
/* Writes to its standard input. False: it does not read any more, or a signal to velo came. */
bool child_write(const Child *child, const char *data, size_t size);
/* Closes its input and waits for its end. abandon: it is ended at once; so it is when a signal
 * to velo comes. which, line: that line of its standard error; empty if there is none.
 * Returns the status of waitpid; -1: the child is not known. */
int child_finish(Child *child, bool abandon, ChildLine which, char *line, size_t size);
/* Starts a program that reads and writes nothing but its files. messages: the file of its
 * standard error. Returns as child_start. */
int child_start_apart(pid_t *child, const char *program, char *const *words,
                      const char *messages);
/* The first line of such a file; empty: there is none. */
void child_first_line(const char *messages, char *line, size_t size);
/* How it ended: "it ended with exit code 3". */
void child_end_text(int status, char *text, size_t size);

#endif
