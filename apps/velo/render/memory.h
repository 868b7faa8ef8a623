/* render/memory.h: memory is reckoned before the render begins: who needs how much, and whether it fits. */
#ifndef APP_RENDER_MEMORY_H
#define APP_RENDER_MEMORY_H

#include "render/channels.h"
#include "render/frames.h"
#include "render/job.h"
#include "render/outputs.h"

enum { MEMORY_NEEDS = 9 };

typedef struct MemoryPlan {
  struct {
    const char *what; /* "film" */
    uint64_t bytes;
  } needs[MEMORY_NEEDS];
  int count;
  uint64_t total; /* estimate of the most that is held at once, the scene's included */
} MemoryPlan;

/* What the scene holds already and what the render, its ground truth and the writing of its files will take. `frames`:
 * null, or the images of a trajectory. */
void memory_plan(MemoryPlan *plan, vlContext *context, const vlWorld *world, const Job *job, const Outputs *outputs,
                 const Channels *channels, const Frames *frames);
/* -1 when it fits into --max-memory (`limit`; 0: none), the process' limits and the machine, or else the exit code:
 * one line was reported, with what needs how much. */
int memory_check(const MemoryPlan *plan, uint64_t limit);
/* "scene 12.0 MB, film 132 MB" */
void memory_list(const MemoryPlan *plan, char *text, size_t size);
/* As a JSON line. */
void memory_report_json(const MemoryPlan *plan, uint64_t limit);
/* The most bytes of memory that the process has had. */
uint64_t memory_peak(void);

#endif
