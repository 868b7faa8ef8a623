/* schema/parameter.case.h: a case of a parameter, for the tests of its kind
 * (test/conformance/parameters.h). */
#ifndef SCHEMA_PARAMETER_CASE_H
#define SCHEMA_PARAMETER_CASE_H

/* parameter null: `base` holds parameters of all scenes of the kind, separated by semicolons.
 * Otherwise: value is the parameter as in a file, instead of a value from its row; base
 * replaces the kind's; no_effect says why the parameter changes nothing, and it is then checked
 * that it does not. family and kind null: in the case of a kind, this kind. kind null: of all
 * kinds of the family. */
typedef struct ParameterCase {
  const char *family, *kind, *parameter;
  const char *base, *value, *no_effect;
  const char *directive; /* the name in the file, where it is not the kind's */
} ParameterCase;

/* Most of the cases of one kind; an entry without any member ends the list. */
enum { PARAMETER_CASES = 8 };

#endif
