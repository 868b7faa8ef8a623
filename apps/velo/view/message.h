/* view/message.h: the messages that a page sends, one JSON object each, and their parser. It
 * trusts nothing: sizes, types and ranges are checked here. docs/view.md lists the messages. */
#ifndef APP_VIEW_MESSAGE_H
#define APP_VIEW_MESSAGE_H

#include "velo/setting.h"

enum {
  MESSAGE_MAX_SIZE = 65536, /* bytes */
  MESSAGE_NAME = 200,       /* longest text of a message, bytes with the zero */
  MESSAGE_NUMBERS = 16,     /* most numbers of a field */
  MESSAGE_FIELDS = 40       /* most fields of an edit */
};

typedef enum MessageKind {
  MESSAGE_SEEN,     /* a frame is drawn: serial */
  MESSAGE_CAMERA,   /* edit the camera: change, gesture, fields */
  MESSAGE_UNDO,     /* the camera before the last gesture */
  MESSAGE_REDO,     /* the camera before the last undo */
  MESSAGE_RESET,    /* the camera of the scene */
  MESSAGE_SETTINGS, /* spp, paused, crop, channel, denoise, mark: those that are given */
  MESSAGE_PICK,     /* what a pixel sees: id, x, y */
  MESSAGE_FOCUS,    /* focus on a pixel: x, y */
  MESSAGE_SAVE,     /* write a file: id, what, name, dialect, exposure, view */
  MESSAGE_COMMAND,  /* write the camera and tell the command: id, exposure, view */
  MESSAGE_VERIFY,   /* run the command that was told last: id; end: ends that */
  MESSAGE_OVERLAY,  /* vanishing points, horizon, boxes, curves: id, boxes, curves, field */
  MESSAGE_OUTLINE,  /* the camera as lines: id, fields: point */
  MESSAGE_OUTSIDE,  /* the scene from outside: id, size, exposure, fields: eye, lookat, up */
  MESSAGE_PATHS,    /* the paths of a pixel: id, x, y, samples, show, by_sample */
  MESSAGE_CAMERAS,  /* the cameras of --trajectory as lines: id */
  MESSAGE_STEER,    /* the sender steers from now on, and no other page */
  MESSAGE_SCENE,    /* another scene of the lecture: name, change */
  MESSAGE_SENSOR,   /* edit the sensor of the mode "camera": change, fields */
  MESSAGE_TIME      /* the shutter opens at another time: at, shutter, change, gesture */
} MessageKind;

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
  MessageKind kind;
  uint32_t serial, change, gesture, id;
  double x, y; /* pixels */
  uint32_t field_count;
  MessageField fields[MESSAGE_FIELDS];
  bool has_spp, has_paused, has_crop, has_channel, has_size, has_denoise; /* of settings */
  uint32_t spp;
  uint32_t samples, show; /* numbers of paths; 0: not given */
  bool paused, denoise, boxes, curves, field, mark, by_sample, end;
  uint32_t crop[4]; /* all 0: none */
  uint32_t size[2]; /* pixels */
  char channel[MESSAGE_NAME], what[MESSAGE_NAME], name[MESSAGE_NAME], dialect[MESSAGE_NAME],
      view[MESSAGE_NAME];
  double exposure;    /* EV */
  double at, shutter; /* seconds: when it opens, how long it stays open */
} ViewMessage;

/* Parses a message of `size` bytes. False: it is malformed; why then holds the reason. */
bool message_parse(const char *text, size_t size, ViewMessage *message,
                   char why[VL_GIVEN_MESSAGE]);

#endif
