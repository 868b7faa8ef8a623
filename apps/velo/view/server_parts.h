/* view/server_parts.h: what the files of the server share. Only server*.c include it. */
#ifndef APP_VIEW_SERVER_PARTS_H
#define APP_VIEW_SERVER_PARTS_H

#include <libwebsockets.h>
#include <pthread.h>

#include "view/access.h"
#include "view/server.h"

enum {
  MAX_CLIENTS = 64,
  MAX_TEXTS = 64,       /* texts that wait for one page */
  FRAGMENT = 64 * 1024, /* bytes of a message that one write hands to the system */
  PORTION = 16 * 1024,  /* bytes of a file that one write hands to the system */
  SEEN_TIMEOUT_SECONDS =
      20 /* a page that does not answer a frame for so long gets the next one all the same */
};

/* A text that waits; LWS_PRE bytes are free before it. */
typedef struct Text {
  struct Text *next;
  size_t size;
  size_t type_size; /* bytes up to the end of the member "type" */
  unsigned char bytes[];
} Text;

typedef struct Client {
  struct lws *wsi;
  uint32_t id; /* from 1, in the order in which the pages came */
  bool steers;
  Text *first, **last;
  unsigned texts;
  ViewFrame *shown;       /* the frame that the page has, or that is on its way */
  uint32_t waits_for;     /* serial of the frame whose arrival it has not told; 0: none */
  time_t sent;            /* when that frame was sent */
  unsigned char *message; /* the frame that is being sent; null: none */
  size_t message_size, message_sent;
  char *received; /* the parts of a message so far */
  size_t received_size;
  enum lws_close_status refused; /* not 0: the page is hung up on, for the reason `why` */
  char why[121];
} Client;

struct Server {
  ServerDef def;
  ServerCalls calls;
  char listen[256]; /* copy of the address; empty: 127.0.0.1 */
  char token[TOKEN_SIZE], address[420];
  int port;
  struct lws_context *lws;
  struct lws_vhost *vhost;
  pthread_t thread;
  bool started;
  atomic_bool quit;
  _Atomic double seconds;
  /* Under the lock: the clients, their texts, the frame. The server's thread alone changes the
   * list of clients. */
  pthread_mutex_t lock;
  Client *clients[MAX_CLIENTS];
  unsigned client_count;
  uint32_t next_id;
  ViewFrame *frame;
};

/* The callbacks of the two protocols. */
int server_http(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                size_t size);
int server_socket(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                  size_t size);
/* The bytes of a connection of each protocol. */
extern const size_t server_http_bytes, server_socket_bytes;

/* Whether a request's Host is right; copies it. */
bool server_check_host(struct lws *wsi, const Server *server, char *host, size_t size);

#endif
