/* main.c: the program: finds the command, parses its options, runs it. */
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command_words.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/context.h"
#include "cli/macros.h"
#include "cli/manual.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "cli/text.h"

/* The git commit of the source; empty when unknown. Written by cmake/commit.cmake. */
extern const char velo_commit[];

/* The command `velo help`. */
enum { HELP_ALL, HELP_MAN, HELP_COMPLETION, HELP_COMMANDS };

static Option help_options[] = {
    {HELP_ALL, "all", "print all options, where the page of COMMAND has the most used only"},
    {HELP_MAN, "man", "print the manual page of COMMAND, or of velo, in the format of man(7)"},
    {HELP_COMPLETION, "completion", "print the completion script of a shell:", OPTION_CHOICE,
     "SHELL", .choices = shell_choices},
    {HELP_COMMANDS, "commands", "print the names of all commands, one per line"},
    {0}};

static int help(const Arguments *arguments, vlContext *context);

static const Command help_command = {
    .name = "help",
    .usage = "[COMMAND] [options]",
    .summary = "print the options of a command",
    .text =
        "Without COMMAND, lists all commands. With COMMAND, prints what it does, its options "
        "in sections\n"
        "(of render the most used ones, --all prints all), and examples. For image, scene, "
        "camera, film or raw, prints this for each command of that group.",
    .examples =
        "velo help render\n"
        "velo help render --all\n"
        "velo help image diff\n"
        "velo help --man render | man -l -",
    .options = help_options,
    .optional_operands = MAX_OPERANDS,
    .run = help,
};

/* Commands of two words ("image diff") come after those of one. */
static const Command *const commands[] = {&render_command,         &view_command,
                                          &trace_command,          &scene_info_command,
                                          &scene_check_command,    &scene_convert_command,
                                          &scene_upgrade_command,  &scene_kinds_command,
                                          &scene_verify_command,   &image_info_command,
                                          &image_diff_command,     &image_convert_command,
                                          &image_check_command,    &image_denoise_command,
                                          &camera_project_command, &camera_unproject_command,
                                          &camera_info_command,    &camera_convert_command,
                                          &camera_verify_command,  &camera_vanishing_command,
                                          &camera_paths_command,   &camera_draw_command,
                                          &film_info_command,      &film_merge_command,
                                          &film_develop_command,   &raw_develop_command,
                                          &raw_info_command,       &sensor_expose_command,
                                          &sensor_verify_command,  &light_info_command,
                                          &help_command,           NULL};
enum { COMMANDS = LENGTH(commands) - 1 };

static void print_overview(void) {
  printf("velo, a photorealistic renderer\n\nusage: velo COMMAND ...\n\n");
  for (const Command *const *c = commands; *c != &help_command; c++)
    printf("  %-16s  %s\n", (*c)->name, (*c)->summary);
  printf("  %-16s  %s\n", "help COMMAND", "print the options of a command");
  printf("  %-16s  %s\n\n", "--version", "print the version");
  options_print_exit_statuses();
}

/* The number of commands in the group of a word. names: their second words. */
static int group_names(const char *word, const char *names[COMMANDS]) {
  int count = 0;
  for (const Command *const *c = commands; *c; c++)
    if (command_second_word(*c) && command_begins_with(*c, word))
      names[count++] = command_second_word(*c);
  return count;
}

/* For the second word alone (velo convert): lists the commands that end with it. */
static bool is_second_word(const char *word, char *list, size_t size) {
  list[0] = 0;
  for (const Command *const *c = commands; *c; c++) {
    const char *second = command_second_word(*c);
    if (second && strcmp(second, word) == 0)
      text_add(list, size, "%s\"velo %s\"", list[0] ? " or " : "", (*c)->name);
  }
  return list[0];
}

/* The command for a file without one (velo model.glb); null: the word is no file's name. */
static const char *command_for_file(const char *word) {
  static const char *const kinds[][2] = {
      {".pbrt", "render"},      {".pbrt.gz", "render"},   {".gltf", "render"},
      {".glb", "render"},       {".obj", "render"},       {".ply", "render"},
      {".stl", "render"},       {".off", "render"},       {".film", "film info"},
      {".exr", "image info"},   {".png", "image info"},   {".jpg", "image info"},
      {".hdr", "image info"},   {".pfm", "image info"},   {".obj.gz", "render"},
      {".ply.gz", "render"},    {".stl.gz", "render"},    {".off.gz", "render"},
      {".yaml", "camera info"}, {".json", "camera info"}, {".dng", "raw info"},
      {".ies", "light info"},   {".ldt", "light info"}};
  for (size_t i = 0; i < LENGTH(kinds); i++)
    if (strlen(word) > strlen(kinds[i][0]) && text_ends_with(word, kinds[i][0]))
      return kinds[i][1];
  return NULL;
}

/* Of a word that is no command. */
static int unknown_word(const char *word) {
  const char *names[COMMANDS + 2];
  char first_words[COMMANDS][40];
  for (int i = 0; i < COMMANDS; i++) {
    text_set(first_words[i], "%.*s", command_first_length(commands[i]), commands[i]->name);
    names[i] = first_words[i];
  }
  names[COMMANDS] = "--version";
  names[COMMANDS + 1] = "--help";
  const char *near = did_you_mean("", word, names, COMMANDS + 2);
  return report_usage("unknown %s \"%s\"%s", word[0] == '-' ? "option" : "command", word,
                      *near ? near : "; \"velo help\" lists the commands");
}

static int unknown_command(int count, const char *const *words) {
  const char *word = words[0], *names[COMMANDS];
  char list[200];
  if (command_for_file(word))
    return report_usage("a command comes first; did you mean \"velo %s %s\"?",
                        command_for_file(word), word);
  if (is_second_word(word, list, sizeof list))
    return report_usage("unknown command \"%s\"; did you mean %s?", word, list);
  const int name_count = group_names(word, names);
  if (!name_count)
    return unknown_word(word);
  text_list(list, sizeof list, names, name_count);
  if (count < 2)
    return report_usage("%s: which of %s?", word, list);
  const char *near = did_you_mean("", words[1], names, name_count);
  if (*near)
    return report_usage("%s: unknown command \"%s\"%s", word, words[1], near);
  return report_usage("%s: unknown command \"%s\"; there are %s", word, words[1], list);
}

/* Prints the help pages of the command or of the group of commands that the words name. */
static int print_help(int count, const char *const *words, bool all) {
  int used;
  const char *names[COMMANDS], *gap = "";
  const Command *command = command_find(commands, count, words, &used);
  if (command) {
    options_print_help(command, all);
    return STATUS_OK;
  }
  if (count == 0) {
    print_overview();
    return STATUS_OK;
  }
  if (count > 1 || !group_names(words[0], names))
    return unknown_command(count, words);
  for (const Command *const *c = commands; *c; c++) {
    if (!command_begins_with(*c, words[0]))
      continue;
    fputs(gap, stdout);
    options_print_help(*c, all);
    gap = "\n";
  }
  return STATUS_OK;
}

static int print_manual(int count, const char *const *words) {
  int used;
  if (count == 0) {
    manual_print_program(commands);
    return STATUS_OK;
  }
  const Command *command = command_find(commands, count, words, &used);
  if (!command)
    return unknown_command(count, words);
  manual_print_command(command);
  return STATUS_OK;
}

static int help(const Arguments *arguments, UNUSED vlContext *context) {
  const int count = arguments->operand_count;
  const char *const *words = arguments->all_operands;
  const OptionValue *v = arguments->values;
  if (v[HELP_MAN].given + v[HELP_COMPLETION].given + v[HELP_COMMANDS].given > 1)
    return report_usage("help: --man, --completion and --commands exclude each other");
  if (count > 0 && (v[HELP_COMPLETION].given || v[HELP_COMMANDS].given))
    return report_usage("help: --completion and --commands take no COMMAND");
  if (v[HELP_MAN].given)
    return print_manual(count, words);
  if (v[HELP_COMPLETION].given)
    completion_print((Shell)v[HELP_COMPLETION].integer, commands);
  else if (v[HELP_COMMANDS].given)
    for (const Command *const *c = commands; *c; c++)
      puts((*c)->name);
  else
    return print_help(count, words, v[HELP_ALL].given);
  return STATUS_OK;
}

/* Prints one line with the version, then one line for each property of the build. */
static int print_version(void) {
  const vlVersion *version = vl_version();
  printf("velo %s\n", version->text);
  if (velo_commit[0])
    printf("commit            %s\n", velo_commit);
  printf("compiler          %s\n", version->compiler);
  printf("instruction sets  %s", version->instruction_sets);
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  vlContext *context;
  if (vl_context_create(&def, &context) == VL_OK) {
    printf("; here %s", context_isa_name(context));
    vl_context_destroy(context);
  }
  printf("\nlibraries         ");
  const vlLibrary *library;
  for (uint32_t i = 0; (library = vl_version_library(i)); i++)
    printf("%s%s%s%s", i ? ", " : "", library->name, library->version[0] ? " " : "",
           library->version);
  putchar('\n');
  return STATUS_OK;
}

static bool asks_help(const char *word) {
  return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
}

static int run(int argc, char **argv) {
  const char *const *words = (const char *const *)argv + 1;
  int count = argc - 1, used = 1;
  for (const Command *const *c = commands; *c; c++)
    options_share((*c)->options, render_command.options);
  if (count < 1) {
    print_overview();
    return STATUS_USAGE;
  }
  if (strcmp(words[0], "--version") == 0)
    return print_version();
  const Command *command =
      asks_help(words[0]) ? &help_command : command_find(commands, count, words, &used);
  if (!command && count == 2 && asks_help(words[1]))
    return print_help(1, words, false);
  if (!command)
    return unknown_command(count, words);
  static Arguments arguments;
  int status = options_parse(command, count - used, argv + 1 + used, &arguments);
  vlContext *context = NULL;
  if (status < 0 && command->context != CONTEXT_OWN)
    status = context_open_for(&arguments, report_log, NULL, &context);
  if (status < 0)
    status = command->run(&arguments, context);
  context_close(context);
  return status;
}

/* std::set_terminate of the C++ library that Embree loads; null without one. Embree's scheduler
 * throws an exception that it does not catch when an allocation fails; that would end the
 * process without a message of velo. */
extern void *set_terminate(void (*handler)(void)) __asm__("_ZSt13set_terminatePFvvE")
    __attribute__((weak));

static void on_terminate(void) {
  static const char text[] = "velo: out of memory in a library (Embree)\n";
  ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(written < 0 ? STATUS_IO : STATUS_OTHER);
}

int main(int argc, char **argv) {
  /* Opens /dev/null for each standard descriptor that is closed, so that no output file gets
   * descriptor 0, 1 or 2 and receives messages. Printing to a closed stdout still fails, since
   * its replacement is read-only. */
  for (int fd = 0; fd <= 2; fd++)
    if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", fd == 1 ? O_RDONLY : O_RDWR) < 0)
      return STATUS_IO;
  signal(SIGPIPE, SIG_IGN); /* a closed pipe must not end a render */
  /* a file that exceeds its size limit is an error like a full disk */
  signal(SIGXFSZ, SIG_IGN);
  signals_install();
  if (set_terminate)
    set_terminate(on_terminate);
  bool json = false;
  for (int i = 1; i < argc; i++)
    json |= strcmp(argv[i], "--log-json") == 0;
  report_setup(json, REPORT_NORMAL);
  int status = run(argc, argv);
  return report_stdout(status);
}
