/* import/pbrt/parser.h: declarations shared by the files of the parser: the file being read,
 * its next token, errors with their lines. parser.c reads directives, files.c files. */
#ifndef IMPORT_PBRT_PARSER_H
#define IMPORT_PBRT_PARSER_H

#include <sys/stat.h>

#include "base/text.h"
#include "import/pbrt/parse.h"
#include "import/pbrt/token.h"

typedef struct vlParser {
  vlContext *context;
  const vlParseTarget *target;
  const char *first; /* path of the first file */
  uint64_t *seen;    /* hash table of the files that were read; 0: empty */
  uint64_t repeated; /* bytes of the files that were read again */
  uint32_t seen_capacity, seen_count;
} vlParser;

typedef struct vlParserFile {
  vlParser *parser;
  struct vlParserFile *parent;
  bool included; /* the file was read by Include: a parameter list may continue in the parent
                    file */
  const char *path;
  dev_t device;
  ino_t inode;
  uint32_t depth;
  vlTokenizer tokens;
  bool has_token;
  vlToken token;
} vlParserFile;

vlSource vl_parse_source(const vlParserFile *file, const vlToken *token);
bool vl_parse_fail(const vlParserFile *file, vlSource source, const char *format, ...)
    VL_PRINTF(3, 4);
bool vl_parse_fail_memory(const vlParserFile *file);
/* Reads the directives of a file. data[size] must be a zero byte; the text is modified. */
bool vl_parse_block(vlParserFile *file, char *data, size_t size);
/* Reads the file that the token `at` names (files.c). */
bool vl_parse_follow(vlParserFile *file, const vlToken *at, const char *name, bool included);

#endif
