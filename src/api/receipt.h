/* api/receipt.h: the internals of receipts (velo/receipt.h), which are JSON trees. */
#ifndef API_RECEIPT_H
#define API_RECEIPT_H

#include <jansson.h>

#include "base/context.h"
#include "film/file.h"
#include "velo/receipt.h"

enum { VL_RECEIPT_FORMAT = 1 };

struct vlReceipt {
  vlContext *context;
  json_t *tree;
  char *text;
};

/* Adds a value to an object, or an element to an array (key null). Takes the reference. False:
 * out of memory. */
bool vl_receipt_put(json_t *parent, const char *key, json_t *value);
/* Adds the settings of def to the tree. False: out of memory. */
bool vl_receipt_put_settings(json_t *tree, const vlReceiptDef *def);

/* Parses the receipt of a film file; its errors name the file. reader->texts.receipt is not
 * null. */
vlResult vl_film_receipt(const vlFilmReader *reader, vlReceipt **receipt, vlError *error);

#endif
