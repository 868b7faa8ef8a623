/* conformance/lamps.h: one luminaire in files of each format and symmetry gives the same light,
 * that of the formula that the files were written from. */
#ifndef TEST_CONFORMANCE_LAMPS_H
#define TEST_CONFORMANCE_LAMPS_H

#include "conformance.h"
#include "files.h"
#include "lights.h"
#include "unit.h"

enum { LAMP_STEP = 30, LAMP_PLANES = 360 / LAMP_STEP, LAMP_ANGLES = 7, LAMP_TEXT = 4096 };

/* Candela at C and gamma, degrees: the same in all quarters. */
static double lamp_intensity(int c, int gamma) {
  double along = cos(c * PI / 180);
  double down = cos(gamma * PI / 180);
  return (1 + 0.4 * down) * (1 + 0.5 * along * along);
}

/* Appends the intensities of planes, each for gamma from 0 to 90 degrees. */
static void append_planes(char text[LAMP_TEXT], int first, int planes, double factor) {
  for (int i = 0; i < planes; i++)
    for (int k = 0; k < LAMP_ANGLES; k++) {
      size_t used = strlen(text);
      snprintf(text + used, LAMP_TEXT - used, "%.9g\n",
               factor * lamp_intensity(LAMP_STEP * (first + i), 15 * k));
    }
}

static void append_angles(char text[LAMP_TEXT], int step, int count) {
  for (int i = 0; i < count; i++) {
    size_t used = strlen(text);
    snprintf(text + used, LAMP_TEXT - used, "%d\n", step * i);
  }
}

/* IES, over this many degrees of C: 90, 180 or 360. */
static void ies_lamp(char text[LAMP_TEXT], int degrees) {
  int planes = degrees / LAMP_STEP + 1;
  snprintf(text, LAMP_TEXT, "IESNA:LM-63-2002\nTILT=NONE\n1 -1 2 %d %d 1 2 0 0 0\n1 1 0\n",
           LAMP_ANGLES, planes);
  append_angles(text, 15, LAMP_ANGLES);
  append_angles(text, LAMP_STEP, planes);
  append_planes(text, 0, planes, 0.5); /* the file's factor is 2 */
}

/* EULUMDAT by its symmetry: 0: none; 2 and 3: of one plane; 4: of both. The intensities are per
 * 1000 lumens of 4000, times a factor of .5. */
static void eulumdat_lamp(char text[LAMP_TEXT], int symmetry) {
  int planes = symmetry == 0   ? LAMP_PLANES
               : symmetry == 4 ? LAMP_PLANES / 4 + 1
                               : LAMP_PLANES / 2 + 1;
  snprintf(text, LAMP_TEXT,
           "company\n1\n%d\n%d\n%d\n%d\n15\nreport\nname\nnumber\nfile\ndate\n"
           "0\n0\n0\n0\n0\n0\n0\n0\n0\n100\n100\n.5\n0\n1\n1\ntype\n4000\ncolour\nindex\n50\n"
           "0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n",
           symmetry, LAMP_PLANES, LAMP_STEP, LAMP_ANGLES);
  append_angles(text, LAMP_STEP, LAMP_PLANES);
  append_angles(text, 15, LAMP_ANGLES);
  append_planes(text, symmetry == 3 ? 3 * LAMP_PLANES / 4 : 0, planes, 0.5);
}

/* The light of a lamp one above the floor, where its rays of gamma 30 and 45 degrees arrive. */
static void check_lamp(const char *name, const char *lamp) {
  char text[TEXT];
  assert_true(write_bytes(name, lamp, strlen(lamp)));
  snprintf(text, sizeof text,
           HEAD "WorldBegin " FLOOR
                "AttributeBegin Translate 0 1 0 LightSource "
                "\"goniometric\" \"string filename\" \"%s\" \"rgb I\" [1 1 1] AttributeEnd\n",
           name);
  for (int c = LAMP_STEP; c < 360; c += 2 * LAMP_STEP) {
    int gamma = c % 90 == 0 ? 45 : 30;
    double r = tan(gamma * PI / 180);
    LightLaws l = ask_floor(text, r * cos(c * PI / 180), -r * sin(c * PI / 180), 1);
    double known = lamp_intensity(c, gamma) / (1 + r * r);
    double found = mean_of(&l.sampled[1]);
    if (!(fabs(found - known) < 2e-3 * known))
      broken("lights", "goniometric", "%s: %.5f arrives at C %d, gamma %d, not %.5f", name,
             found, c, gamma, known);
  }
}

static void laws_of_lamps(void **state) {
  (void)state;
  static const int symmetries[] = {0, 2, 3, 4};
  char lamp[LAMP_TEXT];
  char name[40];
  for (int degrees = 90; degrees <= 360; degrees *= 2) {
    ies_lamp(lamp, degrees);
    snprintf(name, sizeof name, "lamp%d.ies", degrees);
    check_lamp(name, lamp);
  }
  for (int i = 0; i < 4; i++) {
    eulumdat_lamp(lamp, symmetries[i]);
    snprintf(name, sizeof name, "lamp%d.ldt", symmetries[i]);
    check_lamp(name, lamp);
  }
  expect_no_failures();
}

#endif
