/* cli/context.c: see context.h. */
#include "cli/context.h"

#include "cli/confine.h"
#include "cli/signals.h"

/* More threads wait for each other: 1000 on two processors take seconds. */
enum { MAX_PER_PROCESSOR = 4 };

static bool interrupted(UNUSED void *user) {
  return signals_pending() > 0;
}

int context_open(const vlContextDef *def, vlContext **context) {
  const uint32_t max = MAX_PER_PROCESSOR * vl_default_context_def().threads;
  vlContextDef ours = *def;
  ours.keep_inputs = true;
  ours.interrupted = interrupted;
  if (ours.threads > max) {
    ours.threads = max;
    report_note("--threads %u: %u are used, %d for each processor (the image is the same)",
                def->threads, max, MAX_PER_PROCESSOR);
  }
  switch (vl_context_create(&ours, context)) {
    case VL_OK:
      signals_watch(*context);
      return -1;
    case VL_ERROR_MISSING:
      return report_failure(STATUS_MISSING, "--sandbox: there is no such folder");
    case VL_ERROR_ARGUMENT:
    case VL_ERROR_UNSUPPORTED:
      if (def->isa != vl_default_context_def().isa)
        return report_usage("--isa: this machine does not have it");
      return report_usage(
          "the environment variable VELO_ISA must be base, v2, v3 or v4, and the machine "
          "must have it");
    case VL_ERROR_SCENE:
    case VL_ERROR_IO:
    case VL_ERROR_MEMORY:
    case VL_CANCELLED:
      break;
  }
  return report_failure(STATUS_OTHER,
                        "no memory, or the system refuses to start %u threads: --threads N",
                        ours.threads);
}

vlContextDef context_def(const Arguments *arguments) {
  vlContextDef def = vl_default_context_def();
  def.log = report_log;
  def.sandbox = arguments->folders;
  def.sandbox_count = (uint32_t)arguments->folder_count;
  options_put(arguments->command->options, arguments->values, VL_SETTING_CONTEXT, &def);
  return def;
}

int context_open_one(vlContext **context) {
  vlContextDef def = vl_default_context_def();
  def.log = report_log;
  def.threads = 1;
  return context_open(&def, context);
}

int context_open_for(const Arguments *arguments, vlLogFn *log, void *log_user,
                     vlContext **context) {
  vlContextDef def = context_def(arguments);
  Confine confine = {.read_count = 0};
  def.log = log;
  def.log_user = log_user;
  if (arguments->command->context == CONTEXT_ONE)
    def.threads = 1;
  confine_read(&confine, arguments->operands[0]);
  confine_write(&confine, arguments->operands[1]);
  confine_apply(&confine, arguments);
  return context_open(&def, context);
}

void context_close(vlContext *context) {
  signals_forget(context);
  vl_context_destroy(context);
}

const char *context_isa_name(const vlContext *context) {
  switch (vl_context_isa(context)) {
    case VL_ISA_V2:
      return "x86-64-v2";
    case VL_ISA_V3:
      return "x86-64-v3";
    case VL_ISA_V4:
      return "x86-64-v4";
    case VL_ISA_BASE:
    case VL_ISA_AUTO:
      break;
  }
  return "base";
}
