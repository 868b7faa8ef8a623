/* scene/verify_statistics.h: whether two tracers have the same mean, from replicates: images of
 * the same scene with different seeds. docs/verify.md says what the test assumes and how often
 * it is wrong. */
#ifndef APP_SCENE_VERIFY_STATISTICS_H
#define APP_SCENE_VERIFY_STATISTICS_H

#include <stddef.h>
#include <stdint.h>

/* The means of one replicate are `values` numbers in a row: three channels of each cell. A cell
 * is a part of the image: the whole, a block, the pixels of a material, or the light of a group
 * of lights. */
enum { VERIFY_CHANNELS = 3 };
typedef enum VerifyFamily {
  VERIFY_IMAGE,
  VERIFY_BLOCK,
  VERIFY_MATERIAL,
  VERIFY_LIGHT,
  VERIFY_FAMILIES
} VerifyFamily;

/* Levels of the two looks. A comparison counts as different only if it is significant in the
 * first look, and again, in the same direction, in the second one, which has seeds of its own.
 * So a false alarm has a probability of at most FIRST * SECOND, which is below 1 in 1000. */
#define VERIFY_FIRST_LEVEL 0.03
#define VERIFY_SECOND_LEVEL 0.03

/* The difference of two means. */
typedef struct VerifyDifference {
  double a, b;  /* the two means */
  double error; /* standard error of a - b */
  /* probability of a difference at least as large if the means are equal; two-sided */
  double p;
  double z; /* the same as a number of standard deviations of a normal distribution, with the
               sign of a - b */
} VerifyDifference;

/* Probability that |T| is at least t >= 0, for Student's T. */
double verify_student_p(double t, double freedom);
/* The z at which a normal variable has |Z| >= z with probability p; at most 37. */
double verify_normal_z(double p);

/* The variance of a - b between replicates, unbiased: replicate r of both has the same seed,
 * and its value is a[r * stride]. replicates >= 2. */
double verify_variance(const double *a, const double *b, uint32_t replicates, size_t stride);
/* Compares the means of a and b, as above. min: the smallest difference that counts: p is
 * that of the part above it. least_error: the standard error is at least this. A cell in which
 * a tracer has not met its rare bright paths seems to have little noise, so that its mean seems
 * to be too dark beyond chance; the noise of all cells together says how large the error of
 * such a cell is. replicates >= 3. */
VerifyDifference verify_compare(const double *a, const double *b, uint32_t replicates,
                                size_t stride, double min, double min_error);

/* The p below which a value is significant in the first look. of_family: number of values of
 * its family in all comparisons; families: number of families that have any. */
double verify_first_p(uint32_t of_family, uint32_t families);
/* The p (two-sided) below which a value is significant in the second look. marked: number of
 * values that were significant in the first. */
double verify_second_p(uint32_t marked);

#endif
