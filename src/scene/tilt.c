/* scene/tilt.c: see tilt.h. The second moments of a triangle of area A with the corners a, b, c
 * are A / 12 (aa' + bb' + cc' + ss'), s = a + b + c. Their axes are found by Jacobi's method
 * (Golub and Van Loan, "Matrix Computations", section 8.5). */
#include "scene/tilt.h"

#include <math.h>

#include "math/double3.h"
#include "scene/faces.h"

enum { MAX_SWEEPS = 16 };

typedef struct Moments {
  double center[3];
  double area, first[3], second[3][3];
} Moments;

static void add_face(void *user, const vlFace *face) {
  Moments *m = user;
  const double area = face->size;
  double p[4][3];
  for (int i = 0; i < 3; i++) {
    p[3][i] = 0;
    for (int k = 0; k < 3; k++) {
      p[k][i] = face->corners[k][i] - m->center[i];
      p[3][i] += p[k][i];
    }
    m->first[i] += area * p[3][i] / 3;
  }
  m->area += area;
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        m->second[i][j] += area / 12 * p[k][i] * p[k][j];
}

static void turn(double *i, double *j, double cosine, double sine) {
  const double x = *i, y = *j;
  *i = cosine * x - sine * y;
  *j = sine * x + cosine * y;
}

/* Turns the axes i and j of the symmetric matrix a so that a[i][j] becomes 0; the columns of v
 * turn along. */
static void rotate(double a[3][3], double v[3][3], int i, int j) {
  if (a[i][j] == 0)
    return;
  const double theta = (a[j][j] - a[i][i]) / (2 * a[i][j]);
  const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
  const double c = 1 / sqrt(t * t + 1);
  const double s = t * c;
  for (int k = 0; k < 3; k++)
    turn(&a[k][i], &a[k][j], c, s);
  for (int k = 0; k < 3; k++) {
    turn(&a[i][k], &a[j][k], c, s);
    turn(&v[k][i], &v[k][j], c, s);
  }
}

bool vl_tilt_find(const vlScene *scene, const vlExtent *box, double n[3]) {
  const double thin = 1.0 / 64;
  Moments m = {.area = 0};
  double a[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  vl_extent_middle(box, m.center);
  vl_faces_visit(scene, add_face, &m);
  if (!(m.area > 0))
    return false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      a[i][j] = m.second[i][j] / m.area - m.first[i] * m.first[j] / (m.area * m.area);
  for (int sweep = 0; sweep < MAX_SWEEPS; sweep++)
    for (int i = 0; i < 3; i++)
      rotate(a, v, i, (i + 1) % 3);
  int min = 0;
  for (int i = 1; i < 3; i++)
    min = a[i][i] < a[min][min] ? i : min;
  const int one = (min + 1) % 3;
  const int two = (min + 2) % 3;
  const double next = fmin(a[one][one], a[two][two]);
  const double max = fmax(a[one][one], a[two][two]);
  for (int i = 0; i < 3; i++)
    n[i] = v[i][min];
  return isfinite(max) && a[min][min] < thin * next && next > thin * max;
}
