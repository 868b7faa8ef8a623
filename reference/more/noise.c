/* more/noise.c: noise and what is made of it: waves, marble, random dots (pbrt book 10.6; pbrt-v4's tables, so that the
 * patterns are the same). */
#include "more.h"

/* A permutation of 0 to 255 (Perlin 2002). */
static const unsigned char permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

/* Each point with whole coordinates has one of twelve slopes; this is its plane at (x, y, z) from the point. */
static double plane_at(long i, long j, long k, double x, double y, double z) {
  int h = permutation[(permutation[(permutation[i & 255] + j) & 255] + k) & 255] & 15;
  double u = h < 8 || h == 12 || h == 13 ? x : y;
  double v = h < 4 || h == 12 || h == 13 ? y : z;
  return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

/* A step from 0 to 1 without corners. */
static double step(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

static double between(double a, double b, double t) {
  return (1 - t) * a + t * b;
}

/* Between the eight points around, their planes are blended. */
static double noise(vector p) {
  long i = (long)floor(p.x), j = (long)floor(p.y), k = (long)floor(p.z);
  double x = p.x - floor(p.x), y = p.y - floor(p.y), z = p.z - floor(p.z), layer[2];
  for (int dz = 0; dz < 2; dz++) {
    double row[2];
    for (int dy = 0; dy < 2; dy++) {
      double left = plane_at(i, (j & 255) + dy, (k & 255) + dz, x, y - dy, z - dz);
      double right = plane_at((i & 255) + 1, (j & 255) + dy, (k & 255) + dz, x - 1, y - dy, z - dz);
      row[dy] = between(left, right, step(x));
    }
    layer[dz] = between(row[0], row[1], step(y));
  }
  return between(layer[0], layer[1], step(z));
}

/* Octaves of noise, each finer than the one before it by 1.99; or of its absolute value. */
static double octaves_of(vector p, double omega, uint32_t octaves, bool absolute) {
  double sum = 0, frequency = 1, amplitude = 1;
  for (uint32_t i = 0; i < octaves; i++) {
    double value = noise(scale(frequency, p));
    sum += amplitude * (absolute ? fabs(value) : value);
    frequency *= 1.99;
    amplitude *= omega;
  }
  return sum;
}

double fbm(vector p, double omega, uint32_t octaves) {
  return octaves_of(p, omega, octaves, false);
}

/* pbrt-v4 adds the absolute value's mean, 0.2, for the octave after the last one. */
double turbulence(vector p, double omega, uint32_t octaves) {
  return octaves_of(p, omega, octaves, true) + 0.2 * pow(omega, octaves);
}

/* A cloud, thick below y = 0.5 and thin at y = 1: octaves of noise at places that the slopes of finer noise displace
 * (docs/media.md). */
double cloud_density(vector p, double density, double wispiness, double frequency) {
  const double d = 0.01;
  vector q = scale(frequency, p);
  double strength = 0.05 * wispiness, finer = 10;
  for (int i = 0; i < 2; i++) {
    vector at = scale(finer, q);
    vector beside = make_vector(noise(add(at, make_vector(d, 0, 0))), noise(add(at, make_vector(0, d, 0))),
                                noise(add(at, make_vector(0, 0, d))));
    double here = noise(at);
    q = add(q, scale(strength / d, subtract(beside, make_vector(here, here, here))));
    strength /= 2;
    finer *= 1.99;
  }
  double thin = clamp(4.5 * density * (1 - p.y) * fbm(q, 0.5, 5) / 2, 0, 1);
  return fmin(1, thin + 2 * fmax(0, 0.5 - p.y));
}

/* A half of all cells has a dot, at a random place in the cell. */
bool is_in_dot(square_point st) {
  double s = floor(st.x + 0.5), t = floor(st.y + 0.5);
  if (noise(make_vector(s + 0.5, t + 0.5, 0.5)) <= 0) return false;
  double radius = 0.35, most = 0.5 - radius;
  double x = s + most * noise(make_vector(s + 1.5, t + 2.8, 0.5));
  double y = t + most * noise(make_vector(s + 4.5, t + 9.8, 0.5));
  return square(st.x - x) + square(st.y - y) < square(radius);
}

/* Veins along y, displaced by noise: a place on a spline through nine colours. */
void marble(vector p, double omega, uint32_t octaves, double variation, double rgb[3]) {
  static const double colors[9][3] = {{.58, .58, .6}, {.58, .58, .6}, {.58, .58, .6}, {.5, .5, .5},  {.6, .59, .58},
                                      {.58, .58, .6}, {.58, .58, .6}, {.2, .2, .33},  {.58, .58, .6}};
  double t = (0.5 + 0.5 * sin(p.y + variation * fbm(p, omega, octaves))) * 6;
  int first = t < 6 ? (int)t : 5;
  t -= first;
  for (int c = 0; c < 3; c++) {
    double a = colors[first][c], b = colors[first + 1][c], d = colors[first + 2][c], e = colors[first + 3][c];
    double ab = between(a, b, t), bd = between(b, d, t), de = between(d, e, t);
    rgb[c] = 1.5 * between(between(ab, bd, t), between(bd, de, t), t);
  }
}
