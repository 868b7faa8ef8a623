/* view/server.h: the server of the live page: HTTP and WebSocket through libwebsockets, in a
 * thread of its own. It serves the files of web/ from memory, sends frames and texts to the
 * pages, and hands their messages on. Requests need the token in their address; a foreign Host
 * or Origin is refused, and so is a malformed message. */
#ifndef APP_VIEW_SERVER_H
#define APP_VIEW_SERVER_H

#include "view/frame.h"
#include "view/message.h"

typedef struct Server Server;

/* What the owner does; all are called on the server's thread, without a lock of the server. */
typedef struct ServerCalls {
  void *user;
  /* A page came; the texts that it needs are posted to it. */
  void (*greet)(void *user, uint32_t client);
  const MessageType *types; /* of the messages that a page may send */
  /* A valid message. steers: whether its page may change things. */
  void (*message)(void *user, bool steers, const ViewMessage *message);
  /* The number of pages changed. */
  void (*clients)(void *user, uint32_t count);
} ServerCalls;

typedef struct ServerDef {
  const char *address; /* to listen on: an address of this machine; null: 127.0.0.1 */
  int port;            /* 0: a free one. Without an address, runs on one port have one token, so
                          that their pages find them again */
  const char *home;    /* file of the page: "index.html" */
  const char *query;   /* what the address ends with: "", "?language=it" */
  bool steering;       /* one page steers; false: all only look */
} ServerDef;

/* Opens the port; pages that come wait. Returns -1 with *server, or the exit code after
 * reporting the error. */
int server_open(const ServerDef *def, Server **server);
/* Starts the thread. It needs no further sockets of the system. Returns -1 or the exit code. */
int server_start(Server *server, const ServerCalls *calls);
/* Ends the thread, if there is one, and frees the server. Null is allowed. */
void server_stop(Server *server);
/* The address of the page, with its token and query. */
const char *server_address(const Server *server);
int server_port(const Server *server);

/* Sends a text to a page, or to all (client 0). Any thread. */
void server_post(Server *server, uint32_t client, const char *text);
/* Sends a frame to all pages, each when it has drawn the one before. The server keeps a
 * reference. Any thread. */
void server_show(Server *server, ViewFrame *frame);
/* Seconds of processor time that packing and sending took. Any thread. */
double server_seconds(const Server *server);

#endif
