/* scene/verify_report.c: prints the result of `velo scene verify`: a row for each run that was
 * compared, then what differs. */
#include <math.h>
#include <stdio.h>

#include "cli/json.h"
#include "cli/text.h"
#include "scene/verify.h"

static const char *const families[] = {"image", "block", "material", "lights"};
static const char *const channels[] = {"red", "green", "blue"};

static bool is_shown(const VerifyRun *run) {
  return !run->left_out && run->against >= 0;
}

static double ratio_of(const VerifyDifference *d) {
  return d->b != 0 ? d->a / d->b : d->a == 0 ? 1 : INFINITY;
}

/* The farthest z of each family, 0 for those without values. */
static void find_farthest(const Verify *v, const VerifyRun *run, double z[VERIFY_FAMILIES]) {
  for (int f = 0; f < VERIFY_FAMILIES; f++)
    z[f] = 0;
  for (uint32_t value = 0; value < v->cell_count * VERIFY_CHANNELS; value++) {
    const uint32_t cell = value / VERIFY_CHANNELS;
    if (!verify_uses_cell(v, run, cell))
      continue;
    const VerifyDifference d = verify_difference(v, run, 0, value);
    double *farthest = &z[verify_family(run, &v->cells[cell])];
    if (fabs(d.z) > fabs(*farthest))
      *farthest = d.z;
  }
}

static const char *verdict_of(const VerifyRun *run) {
  if (run->apart)
    return "not judged";
  if (run->differs)
    return "DIFFERS";
  return run->marked ? "agrees (second look)" : "agrees";
}

/* "block 3,4 at 24,32" or "material 5 (dielectric glass)" */
static void name_cell(const Verify *v, const VerifyRun *run, uint32_t cell, char *text,
                      size_t size) {
  const VerifyCell *c = &v->cells[cell];
  const VerifyFamily family = verify_family(run, c);
  const uint32_t column = c->index % v->columns, row = c->index / v->columns;
  if (family == VERIFY_BLOCK)
    snprintf(text, size, "block at %u,%u", column * v->width / v->columns,
             row * v->height / v->rows);
  else if (family == VERIFY_MATERIAL && c->index)
    snprintf(text, size, "material %u", c->index);
  else if (family == VERIFY_MATERIAL)
    snprintf(text, size, "background");
  else
    snprintf(text, size, "image");
}

/* Of each family the value that differs most. */
static void print_marks(const Verify *v, int index) {
  const VerifyRun *run = &v->runs[index];
  const VerifyMark *marks[VERIFY_FAMILIES] = {NULL};
  for (uint32_t k = 0; k < v->mark_count; k++) {
    const VerifyMark *mark = &v->marks[k];
    if (mark->run != index || !mark->differs)
      continue;
    const VerifyMark **slot =
        &marks[verify_family(run, &v->cells[mark->value / VERIFY_CHANNELS])];
    if (!*slot || fabs(mark->second.z) > fabs((*slot)->second.z))
      *slot = mark;
  }
  for (int f = 0; f < VERIFY_FAMILIES; f++) {
    char name[80];
    if (!marks[f])
      continue;
    const VerifyDifference *d = &marks[f]->second;
    name_cell(v, run, marks[f]->value / VERIFY_CHANNELS, name, sizeof name);
    printf("%s, %s, %s: %.5g, %s: %.5g; ratio %.4f, z %.1f and %.1f\n", run->name, name,
           channels[marks[f]->value % VERIFY_CHANNELS], d->a, v->runs[run->against].name, d->b,
           ratio_of(d), marks[f]->first.z, d->z);
  }
}

int verify_count(const Verify *v) {
  int count = 0;
  for (int i = 0; i < v->run_count; i++)
    count += v->runs[i].differs > 0;
  return count;
}

void verify_print(const Verify *v) {
  int compared = 0;
  text_print_plain(v->path);
  printf(": %u x %u pixels, %d replicates of each run\n", v->width, v->height,
         VERIFY_REPLICATES);
  printf("%-29s %6s  %-23s  %-27s\n", "", "", "ratio of the images", "farthest z");
  printf("%-29s %6s  %7s %7s %7s  %6s %6s %8s %6s\n", "run", "spp", "red", "green", "blue",
         "image", "block", "material", "lights");
  if (v->unreferenced[0]) {
    printf("%-29s %6s  not compared: ", "reference", "");
    text_print_plain(v->unreferenced);
    putchar('\n');
  }
  for (int i = 0; i < v->run_count; i++) {
    const VerifyRun *run = &v->runs[i];
    double z[VERIFY_FAMILIES];
    if (!is_shown(run))
      continue;
    compared += !run->apart;
    printf("%-29s %6u ", run->name, run->spp[0]);
    for (uint32_t c = 0; c < VERIFY_CHANNELS; c++) {
      const VerifyDifference d = verify_difference(v, run, 0, c);
      printf(" %7.4f", ratio_of(&d));
    }
    find_farthest(v, run, z);
    printf("  %6.1f %6.1f %8.1f %6.1f  %s\n", z[VERIFY_IMAGE], z[VERIFY_BLOCK],
           z[VERIFY_MATERIAL], z[VERIFY_LIGHT], verdict_of(run));
  }
  for (int i = 0; i < v->run_count; i++)
    print_marks(v, i);
  for (int i = 0; i < v->run_count; i++)
    if (v->runs[i].dropped)
      printf("%s: %llu samples were not finite\n", v->runs[i].name,
             (unsigned long long)v->runs[i].dropped);
  for (int i = 0; i < v->note_count; i++)
    printf("%s\n", v->notes[i]);
  printf("%d of %d comparisons differ beyond chance (%u values)\n", verify_count(v), compared,
         v->compared);
}

/* ---- JSON -------------------------------------------------------------------------------- */

static void put_difference(Json *json, const char *key, const VerifyDifference *d) {
  json_begin(json, key, '{');
  json_put(json, "mean %g, against %g, error %g, z %g, p %g", d->a, d->b, d->error, d->z, d->p);
  json_end(json, '}');
}

static void put_run(Json *json, const Verify *v, int index) {
  const VerifyRun *run = &v->runs[index];
  double z[VERIFY_FAMILIES];
  json_begin(json, NULL, '{');
  json_put(json, "run %s, against %s, spp %u, judged %i", run->name, v->runs[run->against].name,
           run->spp[0], !run->apart);
  json_put(json, "first %u, differs %u, not_finite %lld", run->marked, run->differs,
           (long long)run->dropped);
  json_begin(json, "image", '[');
  for (uint32_t c = 0; c < VERIFY_CHANNELS; c++) {
    const VerifyDifference d = verify_difference(v, run, 0, c);
    put_difference(json, NULL, &d);
  }
  json_end(json, ']');
  find_farthest(v, run, z);
  json_begin(json, "farthest", '{');
  for (int f = 0; f < VERIFY_FAMILIES; f++)
    json_number(json, families[f], z[f]);
  json_end(json, '}');
  json_begin(json, "values", '[');
  for (uint32_t k = 0; k < v->mark_count; k++) {
    const VerifyMark *mark = &v->marks[k];
    char name[80];
    if (mark->run != index)
      continue;
    name_cell(v, run, mark->value / VERIFY_CHANNELS, name, sizeof name);
    json_begin(json, NULL, '{');
    json_put(json, "cell %s, channel %s, differs %i", name,
             channels[mark->value % VERIFY_CHANNELS], mark->differs);
    put_difference(json, "first", &mark->first);
    put_difference(json, "second", &mark->second);
    json_end(json, '}');
  }
  json_end(json, ']');
  json_end(json, '}');
}

void verify_print_json(const Verify *v) {
  Json *json = json_open();
  json_put(json, "file %s, width %u, height %u, replicates %d, values %u, differ %d", v->path,
           v->width, v->height, VERIFY_REPLICATES, v->compared, verify_count(v));
  json_begin(json, "runs", '[');
  for (int i = 0; i < v->run_count; i++)
    if (is_shown(&v->runs[i]))
      put_run(json, v, i);
  json_end(json, ']');
  json_text(json, "reference_not_compared", v->unreferenced); /* empty: it is */
  json_begin(json, "notes", '[');
  for (int i = 0; i < v->note_count; i++)
    json_text(json, NULL, v->notes[i]);
  json_end(json, ']');
  json_close(json);
}
