/* image/check_matte.c: checks that a file's Cryptomattes agree with their header. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "image/check.h"
#include "image/header.h"
#include "velo/channels.h"

static const char *const types[3] = {"CryptoObject", "CryptoMaterial", "CryptoInstance"};

/* ---- the manifest ------------------------------------------------------------------------ */

/* Reads a JSON string into `to` (of `size`); null when invalid. \u is not needed: manifests are
 * UTF-8. */
static const char *read_string(const char *at, char *to, size_t size) {
  size_t n = 0;
  at += strspn(at, " \t\r\n");
  if (*at++ != '"')
    return NULL;
  for (; *at && *at != '"'; at++) {
    if (*at == '\\' && *++at != '"' && *at != '\\' && *at != '/')
      return NULL;
    if (n + 1 >= size)
      return NULL;
    to[n++] = *at;
  }
  to[n] = 0;
  return *at == '"' ? at + 1 : NULL;
}

static int compare(const void *a, const void *b) {
  uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return x < y ? -1 : x > y;
}

static bool is_known(const Matte *m, uint32_t bits) {
  return bsearch(&bits, m->known, m->known_count, sizeof bits, compare) != NULL;
}

/* Reads {"name":"hash",...} and checks that each hash is the hash of its name. */
static bool read_manifest(Matte *m, const char *text) {
  char name[1200], hash[16];
  size_t room = strlen(text) / 13 + 1; /* "":"12345678", and the comma */
  m->known = calloc(room, sizeof *m->known);
  const char *at = text + strspn(text, " \t\r\n");
  if (!m->known || *at++ != '{')
    return false;
  at += strspn(at, " \t\r\n");
  while (*at != '}') {
    at = read_string(at, name, sizeof name);
    if (!at)
      return false;
    at += strspn(at, " \t\r\n");
    if (*at++ != ':' || !(at = read_string(at, hash, sizeof hash)))
      return false;
    char *end;
    uint32_t bits = (uint32_t)strtoul(hash, &end, 16);
    if (strlen(hash) != 8 || *end || bits != vl_cryptomatte_hash(name) ||
        m->known_count == room)
      return false;
    m->known[m->known_count++] = bits;
    at += strspn(at, " \t\r\n");
    if (*at == ',')
      at++;
    at += strspn(at, " \t\r\n");
    if (!*at)
      return false;
  }
  qsort(m->known, m->known_count, sizeof *m->known, compare);
  return true;
}

static bool read_header(Check *c, Matte *m, const char *type) {
  static const struct {
    const char *name, *value;
  } fixed[] = {{"hash", "MurmurHash3_32"}, {"conversion", "uint32_to_float32"}, {"name", NULL}};
  char name[64];
  unsigned key = vl_cryptomatte_hash(type) >> 4;
  for (size_t i = 0; i < LENGTH(fixed); i++) {
    text_set(name, "cryptomatte/%07x/%s", key, fixed[i].name);
    const char *value = header_text(c->image, name);
    if (!value || strcmp(value, fixed[i].value ? fixed[i].value : type) != 0)
      return false;
  }
  text_set(name, "cryptomatte/%07x/manifest", key);
  const char *manifest = header_text(c->image, name);
  return manifest && read_manifest(m, manifest);
}

int check_find_mattes(Check *c) {
  for (int k = 0; k < 3; k++) {
    Matte *m = &c->mattes[k];
    for (; m->ranks < 32; m->ranks++) {
      char name[32];
      for (uint32_t part = 0; part < 2; part++) {
        text_set(name, "%s%02u.%c", types[k], m->ranks / 2, "RGBA"[m->ranks % 2 * 2 + part]);
        int at = vl_image_find_channel(c->image, name);
        if (at < 0)
          break;
        if (part == 0)
          m->id[m->ranks] = at;
        if (part == 1)
          m->coverage[m->ranks] = at;
      }
      if (vl_image_find_channel(c->image, name) < 0)
        break;
    }
    if (m->ranks && !read_header(c, m, types[k]))
      return report_failure(STATUS_OTHER, "%s: the header of %s is not that of a Cryptomatte",
                            c->path, types[k]);
  }
  return -1;
}

void check_free_mattes(Check *c) {
  for (int k = 0; k < 3; k++)
    free(c->mattes[k].known);
}

/* ---- a pixel ----------------------------------------------------------------------------- */

/* Sums the coverages and checks the ids: known to the manifest, each once, with coverage, in
 * descending order of coverage. */
static double check_matte(Check *c, const Matte *m) {
  double sum = 0;
  float last = 1;
  bool good = true;
  for (uint32_t r = 0; r < m->ranks; r++) {
    uint32_t bits;
    float coverage = c->pixel[m->coverage[r]];
    memcpy(&bits, &c->pixel[m->id[r]], sizeof bits);
    good = good && (bits != 0) == (coverage > 0) && coverage >= 0 && coverage <= last;
    good = good && (bits == 0 || is_known(m, bits));
    for (uint32_t s = 0; s < r && bits; s++)
      good = good && memcmp(&c->pixel[m->id[s]], &bits, sizeof bits) != 0;
    sum += (double)coverage;
    last = coverage;
  }
  check_that(c, RULE_MATTE_IDS, good);
  check_note(c, RULE_MATTE_SUM,
             sum <= 1          ? 0
             : sum - 1 <= 1e-6 ? 1e-9
             : sum <= 2        ? sum - 1
                               : (double)INFINITY);
  return sum;
}

/* Objects and materials must have the same total coverage, the image's alpha. When the last
 * rank is used, coverage may be missing. */
void check_mattes(Check *c) {
  double sums[3] = {0, 0, 0};
  bool whole[3] = {false, false, false};
  for (int k = 0; k < 3; k++) {
    const Matte *m = &c->mattes[k];
    if (!m->ranks)
      continue;
    sums[k] = check_matte(c, m);
    whole[k] = c->pixel[m->coverage[m->ranks - 1]] == 0;
  }
  for (int k = 0; k < 2; k++)
    if (whole[k] && c->alpha >= 0 && c->matte_is_alpha)
      check_note(c, RULE_MATTE_SUM, fabs(sums[k] - (double)c->pixel[c->alpha]));
  if (whole[0] && whole[1])
    check_note(c, RULE_MATTE_SUM, fabs(sums[0] - sums[1]));
  if (whole[0] && c->mattes[2].ranks)
    check_note(c, RULE_MATTE_SUM, fmax(0, sums[2] - sums[0]));
}
