/* raw/tone.c: sRGB's curve to 16 bits, by a table. */
#include "raw/tone.h"

#include "image/pixel.h"

enum { PART = 1024, WHITE = VL_TONE_CODES - 1 };

static void begin_part(void *user, uint32_t part, VL_UNUSED uint32_t worker) {
  vlTone *tone = user;
  for (uint32_t code = part * PART; code < (part + 1) * PART; code++)
    tone->begin[code] = vl_srgb_to_linear(((double)code - 0.5) / WHITE);
}

void vl_tone_make(vlContext *context, vlTone *tone) {
  vl_parallel_for(context, VL_TONE_CODES / PART, begin_part, tone);
  tone->begin[0] = 0.0;
  tone->begin[VL_TONE_CODES] = 2.0; /* no value gets there */
  for (uint32_t i = 0; i <= VL_TONE_CELLS; i++)
    tone->near[i] = (float)(vl_linear_to_srgb((double)i / VL_TONE_CELLS) * WHITE + 0.5);
}

/* Interpolation finds the code itself of most values, else one of its neighbours; the loops
 * make sure. */
static inline uint32_t code_of(const vlTone *tone, double linear) {
  float position = (float)(linear * VL_TONE_CELLS);
  uint32_t cell = (uint32_t)position;
  cell = cell < VL_TONE_CELLS ? cell : VL_TONE_CELLS - 1;
  float low = tone->near[cell], high = tone->near[cell + 1];
  uint32_t code = (uint32_t)(low + (high - low) * (position - (float)cell));
  code = code < VL_TONE_CODES ? code : WHITE;
  while (linear < tone->begin[code])
    code--;
  while (linear >= tone->begin[code + 1])
    code++;
  return code;
}

void vl_tone_apply(const vlTone *tone, double scale, const float *values, size_t count,
                   uint16_t *codes) {
  for (size_t i = 0; i < count; i++) {
    double linear = scale * (double)values[i];
    uint32_t code = 0;
    if (linear >= 1.0) {
      code = WHITE;
    } else if (linear > 0.0) { /* and no NaN */
      code = code_of(tone, linear);
    }
    codes[i] = (uint16_t)code;
  }
}
