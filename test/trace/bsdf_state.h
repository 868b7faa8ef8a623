/* bsdf_state.h: the setup of tests of one BSDF: a context, its kernels, room for three
 * batches. */
#ifndef TEST_TRACE_BSDF_STATE_H
#define TEST_TRACE_BSDF_STATE_H

#include "bsdf_batch.h"

#define PI 3.14159265358979323846

typedef struct State {
  vlContext *context;
  const vlBsdfKernels *kernels;
  Batch *batch, *other, *interface;
  vlCoatTable *coats[4]; /* tables that a test builds */
} State;

static int setup(void **state) {
  State *s = calloc(1, sizeof *s);
  vlContextDef def = vl_default_context_def();
  if (vl_context_create(&def, &s->context))
    return 1;
  s->kernels = vl_bsdf_kernels(vl_context_isa(s->context));
  s->batch = calloc(1, sizeof *s->batch);
  s->other = calloc(1, sizeof *s->other);
  s->interface = calloc(1, sizeof *s->interface);
  *state = s;
  return 0;
}
static int teardown(void **state) {
  State *s = *state;
  for (int i = 0; i < 4; i++)
    vl_coat_free(s->context, s->coats[i]);
  vl_context_destroy(s->context);
  free(s->batch);
  free(s->other);
  free(s->interface);
  free(s);
  return 0;
}

#endif
