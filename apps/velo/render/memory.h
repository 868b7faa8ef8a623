/* render/memory.h: estimates the memory of a render before it begins, and checks that it is
 * available. */
#ifndef APP_RENDER_MEMORY_H
#define APP_RENDER_MEMORY_H

#include "render/channels.h"
#include "render/frames.h"
#include "render/job.h"
#include "render/outputs.h"

enum { MEMORY_NEEDS = 10 };

typedef struct MemoryPlan {
  struct {
    const char *what; /* "film" */
    uint64_t bytes;
  } needs[MEMORY_NEEDS];
  int count;
  uint64_t total; /* estimated peak, including the scene */
} MemoryPlan;

/* Estimates the memory held by the scene and needed by the render, its ground truth and the
 * writing of its files. `frames`: null, or the images of a trajectory. */
void memory_plan(MemoryPlan *plan, const Job *job, const Outputs *outputs,
                 const Channels *channels, const Frames *frames);
/* Adds an optional item to the plan. Does nothing for 0 bytes. */
void memory_add(MemoryPlan *plan, const char *what, uint64_t bytes);
/* Returns -1 if the plan fits within --max-memory (`limit`; 0: none), the process's limits and
 * the machine's memory. Otherwise returns the exit code after one line that lists the items. */
int memory_check(const MemoryPlan *plan, uint64_t limit);
/* Text such as "scene 12.0 MB, film 132 MB". */
void memory_list(const MemoryPlan *plan, char *text, size_t size);
/* Reports the plan as a JSON line. */
void memory_report_json(const MemoryPlan *plan, uint64_t limit);
/* Peak memory of the process in bytes. */
uint64_t memory_peak(void);

#endif
