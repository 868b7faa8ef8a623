/* base/text.h: names and paths. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "velo/base.h"

/* In a function with the parameters (..., const char *format, ...): writes what printf would
 * into the array `text`. */
#define VL_FORMAT(text, format)                       \
  do {                                                \
    va_list arguments;                                \
    va_start(arguments, format);                      \
    vsnprintf(text, sizeof(text), format, arguments); \
    va_end(arguments);                                \
  } while (0)

/* The number of elements of an array. */
#define VL_LENGTH(array) (sizeof(array) / sizeof *(array))

/* The accepted name nearest to `name` by edit distance (case ignored), or null if none is near
 * (more than a third of the letters differ). */
const char *vl_nearest_name(const char *name, const char *const *names, size_t count);
/* The index of the name that is this word; count: none is, or the word is null. */
size_t vl_name_index(const char *word, const char *const *names, size_t count);
/* Whether a word is one of the array `names`. */
#define VL_IS_AMONG(word, names) \
  (vl_name_index(word, names, VL_LENGTH(names)) < VL_LENGTH(names))
/* Edit distance with transpositions; case ignored. */
uint32_t vl_edit_distance(const char *a, const char *b);
/* Writes the end of an error message: `; the nearest is "NAME"`, or, if none is near, `; known
 * are A, B, C`. */
void vl_tell_names(char *text, size_t size, const char *name, const char *const *names,
                   size_t count);
/* Appends a name to a list in an error message: ": first, second, third". A name that does not
 * fit is omitted. */
void vl_list_name(char *list, size_t size, const char *name);
/* vl_short_text of `length` bytes, which may hold zeros. */
vlShortText vl_short_text_of(const char *text, size_t length);
/* An argument of the caller's, as messages show it. */
typedef struct vlArgumentText {
  char text[256];
} vlArgumentText;
/* As vl_short_text, but the first 200 characters, or fewer if they take more than 252 bytes:
 * for what the caller has written, not for text from files. */
vlArgumentText vl_argument_text(const char *text);
/* Where the message quotes this text as an argument, it quotes it as vl_short_text: for text
 * from a file that was an argument of a call. */
void vl_shorten_quoted(vlError *error, const char *text);
/* Replaces the same characters as vl_short_text by "?", but in a whole message and without
 * shortening it, so names of files stay complete. Removes an incomplete UTF-8 sequence at the
 * end. */
void vl_make_printable(char *message);
/* Whether a character is white space in C's own locale, whatever the program's is. */
static inline bool vl_is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}
/* Number of bytes of the UTF-8 character at text[0, length), which is not empty; 0 if the bytes
 * are not valid or incomplete. *code: its code point. */
size_t vl_utf8_length(const char *text, size_t length, uint32_t *code);
bool vl_is_utf8(const char *text);
/* Length of one of jansson's messages without its end (" near '...'"), which quotes the
 * file. */
size_t vl_json_problem_length(const char *message);
/* Whether the text is this word; false if it is null. */
static inline bool vl_text_is(const char *text, const char *word) {
  return text && strcmp(text, word) == 0;
}
/* Whether the word is one of `words`, which blanks separate. Null is none. */
bool vl_has_word(const char *words, const char *word);
/* The same for a word of `length` bytes. */
bool vl_has_word_of(const char *words, const char *word, size_t length);
bool vl_ends_with(const char *text, const char *suffix); /* case ignored */
/* Length of the folder's part of a path, including its slash; 0: the current folder. */
size_t vl_folder_length(const char *path);
/* The part of a path behind its folder. */
static inline const char *vl_file_name(const char *path) {
  return path + vl_folder_length(path);
}
/* What stands behind the last dot of a name; all of it where there is none. */
const char *vl_last_part(const char *name);
/* The folder's part of a path, or ".". False: it is too long. */
bool vl_folder_of(const char *path, char *folder, size_t size);
/* Whether a path names a lamp file, by its end: .ies or .ldt. Null: it does not. */
bool vl_names_lamp(const char *path);
/* result = folder of the file base_file + name; name alone if it is absolute. False: it does
 * not fit. */
bool vl_path_join(const char *base_file, const char *name, char *result, size_t size);

#endif
