/* view/message.h: the messages that a page sends, one JSON object each, and their parser. It
 * trusts nothing: sizes, types and ranges are checked here. docs/view.md lists the messages. */
#ifndef APP_VIEW_MESSAGE_H
#define APP_VIEW_MESSAGE_H

#include "cli/macros.h"
#include "velo/setting.h"

enum {
  MESSAGE_MAX_SIZE = 65536, /* bytes */
  MESSAGE_NAME = 200,       /* longest text of a message, bytes with the zero */
  MESSAGE_NUMBERS = 16,     /* most numbers of a field */
  MESSAGE_FIELDS = 40,      /* most fields of an edit */
  MESSAGE_TYPES = 32        /* most types */
};

/* Members of a message. */
typedef enum MessageMember {
  MEMBER_CHANGE = 1 << 0, /* each type has this one, */
  MEMBER_ID = 1 << 1,     /* and this: the number of the answer */
  MEMBER_SERIAL = 1 << 2,
  MEMBER_GESTURE = 1 << 3,
  MEMBER_X = 1 << 4,
  MEMBER_Y = 1 << 5,
  MEMBER_EXPOSURE = 1 << 6,
  MEMBER_AT = 1 << 7,
  MEMBER_SHUTTER = 1 << 8,
  MEMBER_SAMPLES = 1 << 9,
  MEMBER_SHOW = 1 << 10,
  MEMBER_SPP = 1 << 11,
  MEMBER_PAUSED = 1 << 12,
  MEMBER_DENOISE = 1 << 13,
  MEMBER_BOXES = 1 << 14,
  MEMBER_CURVES = 1 << 15,
  MEMBER_FIELD = 1 << 16,
  MEMBER_MARK = 1 << 17,
  MEMBER_BY_SAMPLE = 1 << 18,
  MEMBER_END = 1 << 19,
  MEMBER_CROP = 1 << 20,
  MEMBER_SIZE = 1 << 21,
  MEMBER_CHANNEL = 1 << 22,
  MEMBER_WHAT = 1 << 23,
  MEMBER_NAME = 1 << 24,
  MEMBER_DIALECT = 1 << 25,
  MEMBER_VIEW = 1 << 26,
  MEMBER_SET = 1 << 27 /* fields of an edit */
} MessageMember;

/* Who answers a message, and when. */
typedef enum MessagePlace {
  MESSAGE_SEEN,    /* the server: the page has drawn a frame */
  MESSAGE_STEER,   /* the server: the page steers from now on, and no other */
  MESSAGE_AT_ONCE, /* the engine, when the message comes; it has the lock then */
  MESSAGE_SAVES,   /* the engine's render thread, which has the film; files are written */
  MESSAGE_ASKS     /* the engine's thread for questions */
} MessagePlace;

struct Engine;
struct ViewMessage;

/* A type of message. */
typedef struct MessageType {
  const char *name; /* null: the end of the table */
  uint32_t members; /* MessageMember: what it has; others are not read */
  MessagePlace place;
  void (*answer)(struct Engine *engine, const struct ViewMessage *message);
  bool harmless; /* it changes nothing that others see: pages that only look may send it */
} MessageType;

/* All types, with the engine's answers (engine_messages.c). */
extern const MessageType message_types[];

/* A field of an edit: numbers, or a text. */
typedef struct MessageField {
  char name[24];
  uint32_t count; /* of numbers; 0: it is a text, or null (`null`) */
  bool null;      /* removes the field */
  double numbers[MESSAGE_NUMBERS];
  char text[40];
  int choice; /* of a text: the index that camera_edit finds */
} MessageField;

typedef struct ViewMessage {
  const MessageType *type;
  uint32_t client; /* the page that sent it; the server notes it */
  uint32_t given;  /* MessageMember: those that the page has sent */
  uint32_t serial, change, gesture, id;
  double x, y; /* pixels */
  uint32_t field_count;
  MessageField fields[MESSAGE_FIELDS];
  uint32_t spp;
  uint32_t samples, show; /* numbers of paths; 0: not given */
  bool paused, denoise, boxes, curves, field, mark, by_sample, end;
  uint32_t crop[4]; /* pixels; all 0: none */
  uint32_t size[2]; /* pixels */
  char channel[MESSAGE_NAME], what[MESSAGE_NAME], name[MESSAGE_NAME], dialect[MESSAGE_NAME],
      view[MESSAGE_NAME];
  double exposure;    /* EV */
  double at, shutter; /* seconds: when it opens, how long it stays open */
} ViewMessage;

/* Parses a message of `size` bytes of one of the types. False: it is malformed; why then holds
 * the reason. */
bool message_parse(const MessageType *types, const char *text, size_t size,
                   ViewMessage *message, char why[VL_GIVEN_MESSAGE]);
/* Puts the reason why a message is refused into the error. Returns its code, ARGUMENT. */
vlResult message_refuse(vlError *error, const char *format, ...) PRINTF(2, 3);

#endif
