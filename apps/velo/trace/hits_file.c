/* trace/hits_file.c: see hits_file.h. */
#include "trace/hits_file.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/text.h"

const HitsField hits_fields[HITS_FIELDS] = {
    {"valid", "|b1", 0, offsetof(vlCastHits, valid)},
    {"t", "<f8", 0, offsetof(vlCastHits, t)},
    {"distance", "<f8", 0, offsetof(vlCastHits, distance)},
    {"position", "<f8", 3, offsetof(vlCastHits, position)},
    {"normal", "<f4", 3, offsetof(vlCastHits, normal)},
    {"shading_normal", "<f4", 3, offsetof(vlCastHits, shading_normal)},
    {"uv", "<f4", 2, offsetof(vlCastHits, uv)},
    {"velocity", "<f8", 3, offsetof(vlCastHits, velocity)},
    {"object_id", "<u4", 0, offsetof(vlCastHits, object)},
    {"instance_id", "<u4", 0, offsetof(vlCastHits, instance)},
    {"primitive_id", "<u4", 0, offsetof(vlCastHits, primitive)},
    {"material_id", "<u4", 0, offsetof(vlCastHits, material)}};

size_t hits_field_size(const HitsField *field) {
  return (size_t)(field->type[2] - '0') * (field->columns ? field->columns : 1);
}

const char *hits_field_rows(const vlCastHits *hits, const HitsField *field) {
  const char *rows;
  memcpy(&rows, (const char *)hits + field->offset, sizeof rows);
  return rows;
}

/* ---- .csv -------------------------------------------------------------------------------- */

static void put_row(const vlCastHits *h, uint64_t k, FILE *out) {
  const double *p = h->position + 3 * k, *v = h->velocity + 3 * k;
  const float *n = h->normal + 3 * k, *s = h->shading_normal + 3 * k, *uv = h->uv + 2 * k;
  fprintf(out, "%d,%.17g,%.17g,%.17g,%.17g,%.17g", h->valid[k], h->t[k], h->distance[k], p[0],
          p[1], p[2]);
  fprintf(out, ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", (double)n[0], (double)n[1],
          (double)n[2], (double)s[0], (double)s[1], (double)s[2], (double)uv[0], (double)uv[1]);
  fprintf(out, ",%.17g,%.17g,%.17g", v[0], v[1], v[2]);
  fprintf(out, ",%u,%u,%u,%u\n", h->object[k], h->instance[k], h->primitive[k], h->material[k]);
}

void hits_write_csv(const HitsFile *h, FILE *out) {
  if (h->occluded) {
    fprintf(out, "ray,occluded\n");
    for (uint64_t i = 0; i < h->count && !ferror(out); i++)
      fprintf(out, "%" PRIu64 ",%d\n", i, h->occluded[i]);
    return;
  }
  fprintf(out,
          "ray,hit,valid,t,distance,x,y,z,normal_x,normal_y,normal_z,shading_x,shading_y,"
          "shading_z,u,v,velocity_x,velocity_y,velocity_z,object,instance,primitive,"
          "material\n");
  for (uint64_t i = 0; i < h->count && !ferror(out); i++)
    for (uint32_t k = 0; k < h->hits; k++) {
      uint64_t row = i * h->hits + k;
      if (k && !h->rows.valid[row])
        break;
      fprintf(out, "%" PRIu64 ",%u,", i, k);
      put_row(&h->rows, row, out);
    }
}

/* ---- .npy -------------------------------------------------------------------------------- */

size_t hits_npy_start(char start[HITS_NPY_START], const char *type, const char *shape) {
  char header[HITS_NPY_START / 2];
  int length =
      text_set(header, "{'descr': %s, 'fortran_order': False, 'shape': (%s), }", type, shape);
  const size_t before = 10, total = (before + (size_t)length + 1 + 63) / 64 * 64,
               size = total - before;
  memcpy(start, "\x93NUMPY\1\0", 8);
  start[8] = (char)(size & 255);
  start[9] = (char)(size >> 8);
  snprintf(start + before, HITS_NPY_START - before, "%-*s\n", (int)size - 1, header);
  return total;
}

static void put_start(FILE *out, const char *type, const char *shape) {
  char start[HITS_NPY_START];
  fwrite(start, 1, hits_npy_start(start, type, shape), out);
}

static void put_record(const vlCastHits *h, uint64_t k, FILE *out) {
  for (const HitsField *f = hits_fields; f < hits_fields + HITS_FIELDS; f++)
    fwrite(hits_field_rows(h, f) + k * hits_field_size(f), hits_field_size(f), 1, out);
}

/* "[('valid', '|b1'), ('position', '<f8', (3,)), ...]" */
static void name_fields(char type[HITS_NPY_START / 2]) {
  type[0] = 0;
  for (int i = 0; i < HITS_FIELDS; i++) {
    const HitsField *f = &hits_fields[i];
    text_add(type, HITS_NPY_START / 2, "%s('%s', '%s'", i ? ", " : "[", f->name, f->type);
    if (f->columns)
      text_add(type, HITS_NPY_START / 2, ", (%u,)", f->columns);
    text_add(type, HITS_NPY_START / 2, ")");
  }
  text_add(type, HITS_NPY_START / 2, "]");
}

void hits_write_npy(const HitsFile *h, FILE *out) {
  char shape[64], type[HITS_NPY_START / 2];
  if (h->hits > 1 && !h->occluded)
    text_set(shape, "%" PRIu64 ", %u", h->count, h->hits);
  else
    text_set(shape, "%" PRIu64 ",", h->count);
  if (h->occluded) {
    put_start(out, "'|b1'", shape);
    fwrite(h->occluded, 1, h->count, out);
    return;
  }
  name_fields(type);
  put_start(out, type, shape);
  for (uint64_t k = 0; k < h->count * h->hits && !ferror(out); k++)
    put_record(&h->rows, k, out);
}
