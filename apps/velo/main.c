/* main.c: the program: finds the command, parses its options, runs it. */
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

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

/* Commands of two words ("image diff") come last. */
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
                                          &sensor_verify_command,  &light_info_command};
enum { COMMANDS = LENGTH(commands) };

static void print_overview(void) {
  printf("velo, a photorealistic renderer\n\nusage: velo COMMAND ...\n\n");
  for (int i = 0; i < COMMANDS; i++)
    printf("  %-16s  %s\n", commands[i]->name, commands[i]->summary);
  printf("  %-16s  %s\n", "help COMMAND", "print the options of a command");
  printf("  %-16s  %s\n\n", "--version", "print the version");
  options_print_exit_statuses();
}

/* Returns the number of words of argv that name the command, or 0 if they name another
 * command. */
static int name_words(const Command *command, int argc, char **argv) {
  const char *space = strchr(command->name, ' ');
  if (!space)
    return argc >= 1 && strcmp(argv[0], command->name) == 0 ? 1 : 0;
  size_t n = (size_t)(space - command->name);
  return argc >= 2 && strlen(argv[0]) == n && strncmp(argv[0], command->name, n) == 0 &&
                 strcmp(argv[1], space + 1) == 0
             ? 2
             : 0;
}

/* Whether the word is the first of commands of two words. names: their second words. */
static bool is_family(const char *word, const char *names[COMMANDS], int *count) {
  *count = 0;
  size_t n = strlen(word);
  for (int i = 0; i < COMMANDS; i++)
    if (strncmp(commands[i]->name, word, n) == 0 && commands[i]->name[n] == ' ')
      names[(*count)++] = commands[i]->name + n + 1;
  return *count > 0;
}

static const Command *find_command(int argc, char **argv, int *words) {
  for (int i = 0; i < COMMANDS; i++)
    if ((*words = name_words(commands[i], argc, argv)))
      return commands[i];
  return NULL;
}

/* For the second word alone (velo convert): lists the commands that end with it. */
static bool is_second_word(const char *word, char *list, size_t size) {
  list[0] = 0;
  for (int i = 0; i < COMMANDS; i++) {
    const char *space = strchr(commands[i]->name, ' ');
    if (!space || strcmp(space + 1, word) != 0)
      continue;
    text_add(list, size, "%s\"velo %s\"", list[0] ? " or " : "", commands[i]->name);
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

static int unknown_command(int argc, char **argv) {
  const char *names[COMMANDS + 3];
  char whole[200];
  int count;
  if (command_for_file(argv[0]))
    return report_usage("a command comes first; did you mean \"velo %s %s\"?",
                        command_for_file(argv[0]), argv[0]);
  if (is_second_word(argv[0], whole, sizeof whole))
    return report_usage("unknown command \"%s\"; did you mean %s?", argv[0], whole);
  if (is_family(argv[0], names, &count)) {
    char list[200];
    text_list(list, sizeof list, names, count);
    if (argc < 2)
      return report_usage("%s: which of %s?", argv[0], list);
    const char *near = did_you_mean("", argv[1], names, count);
    if (*near)
      return report_usage("%s: unknown command \"%s\"%s", argv[0], argv[1], near);
    return report_usage("%s: unknown command \"%s\"; there are %s", argv[0], argv[1], list);
  }
  char first_words[COMMANDS][40];
  for (int i = 0; i < COMMANDS; i++) {
    text_set(first_words[i], "%.*s", (int)strcspn(commands[i]->name, " "), commands[i]->name);
    names[i] = first_words[i];
  }
  names[COMMANDS] = "help";
  names[COMMANDS + 1] = "--version";
  names[COMMANDS + 2] = "--help";
  const char *near = did_you_mean("", argv[0], names, COMMANDS + 3);
  return report_usage("unknown %s \"%s\"%s", argv[0][0] == '-' ? "option" : "command", argv[0],
                      *near ? near : "; \"velo help\" lists the commands");
}

/* Values of the options of `velo help`. */
enum { HELP_ALL, HELP_MAN, HELP_COMPLETION, HELP_COMMANDS };

static Option help_options[] = {
    {HELP_ALL, "all", "print all options, where the page of COMMAND has the most used only"},
    {HELP_MAN, "man", "print the manual page of COMMAND, or of velo, in the format of man(7)"},
    {HELP_COMPLETION, "completion", "print the completion script of a shell:", OPTION_CHOICE,
     "SHELL", .choices = shell_choices},
    {HELP_COMMANDS, "commands", "print the names of all commands, one per line"},
    {0}};

static const Command help_command = {
    .name = "help",
    .usage = "[COMMAND] [options]",
    .summary = "print the options of a command",
    .text =
        "Without COMMAND, lists all commands. With COMMAND, prints what it does, its options "
        "in sections\n(of render the most used ones, --all prints all), and examples. For "
        "image, scene, camera, film or raw, prints this for each command of that group.",
    .examples =
        "velo help render\nvelo help render --all\nvelo help image diff\nvelo help --man "
        "render | man -l -",
    .options = help_options,
    .max_operands = MAX_OPERANDS,
};

/* Prints the help pages of one command or of a group of commands. */
static int print_help(int argc, char **argv, bool all) {
  int words, count;
  const char *names[COMMANDS];
  const Command *command = find_command(argc, argv, &words);
  if (!command && argc == 1 && strcmp(argv[0], "help") == 0)
    command = &help_command;
  if (command) {
    options_print_help(command, all);
  } else if (argc == 0) {
    print_overview();
  } else if (argc == 1 && is_family(argv[0], names, &count)) {
    for (int i = 0; i < COMMANDS; i++) {
      if (strncmp(commands[i]->name, argv[0], strlen(argv[0])) != 0)
        continue;
      if (count-- < (int)(LENGTH(names)))
        options_print_help(commands[i], all);
      if (count)
        printf("\n");
    }
  } else {
    return unknown_command(argc, argv);
  }
  return STATUS_OK;
}

/* `velo help`, argv without these words. */
static int help(int argc, char **argv) {
  static Arguments arguments;
  TRY(options_parse(&help_command, argc, argv, &arguments));
  argc = arguments.operand_count; /* the operands now come first in argv */
  const OptionValue *v = arguments.values;
  if (v[HELP_MAN].given + v[HELP_COMPLETION].given + v[HELP_COMMANDS].given > 1)
    return report_usage("help: --man, --completion and --commands exclude each other");
  if (argc > 0 && (v[HELP_COMPLETION].given || v[HELP_COMMANDS].given))
    return report_usage("help: --completion and --commands take no COMMAND");
  const Command *all[COMMANDS + 1];
  memcpy(all, commands, sizeof commands);
  all[COMMANDS] = &help_command;
  if (v[HELP_COMPLETION].given) {
    completion_print((Shell)v[HELP_COMPLETION].integer, all, COMMANDS + 1, &help_command);
  } else if (v[HELP_COMMANDS].given) {
    for (int i = 0; i <= COMMANDS; i++)
      puts(all[i]->name);
  } else if (v[HELP_MAN].given && argc == 0) {
    manual_print_program(all, COMMANDS + 1);
  } else if (v[HELP_MAN].given) {
    int words;
    const Command *command = argc == 1 && strcmp(argv[0], "help") == 0
                                 ? &help_command
                                 : find_command(argc, argv, &words);
    if (!command)
      return unknown_command(argc, argv);
    manual_print_command(command);
  } else {
    return print_help(argc, argv, v[HELP_ALL].given);
  }
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

static int run(int argc, char **argv) {
  for (int i = 0; i < COMMANDS; i++)
    options_share(commands[i]->options, render_command.options);
  if (argc < 2) {
    print_overview();
    return STATUS_USAGE;
  }
  const char *first = argv[1];
  if (strcmp(first, "--version") == 0) {
    return print_version();
  }
  if (strcmp(first, "help") == 0)
    return help(argc - 2, argv + 2);
  if (strcmp(first, "--help") == 0 || strcmp(first, "-h") == 0)
    return help(argc - 2, argv + 2);
  int words;
  const Command *command = find_command(argc - 1, argv + 1, &words);
  if (!command && argc == 3 && (strcmp(argv[2], "--help") == 0 || strcmp(argv[2], "-h") == 0))
    return print_help(1, argv + 1, false);
  if (!command)
    return unknown_command(argc - 1, argv + 1);
  static Arguments arguments;
  int status = options_parse(command, argc - 1 - words, argv + 1 + words, &arguments);
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
  signal(SIGXFSZ,
         SIG_IGN); /* a file that exceeds its size limit is an error like a full disk */
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
