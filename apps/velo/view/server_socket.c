/* view/server_socket.c: the server's WebSockets: one client for each page. Texts go before
 * frames. A page gets the next frame when it has told that it drew the one before, so that a
 * slow link holds one frame at most. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/macros.h"
#include "view/server_parts.h"

/* A connection. */
typedef struct Connection {
  Client *client; /* null before the page is accepted */
} Connection;

const size_t server_socket_bytes = sizeof(Connection);

static time_t now_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec;
}

static Server *server_of(struct lws *wsi) {
  return lws_context_user(lws_get_context(wsi));
}

/* Whether a request to open a WebSocket is one of the page. */
static bool is_ours(struct lws *wsi) {
  const Server *server = server_of(wsi);
  char host[256], origin[300], path[128];
  if (!server_check_host(wsi, server, host, sizeof host))
    return false;
  if (lws_hdr_copy(wsi, origin, sizeof origin, WSI_TOKEN_ORIGIN) <= 0 ||
      !access_origin(origin, host))
    return false;
  if (lws_hdr_copy(wsi, path, sizeof path, WSI_TOKEN_GET_URI) <= 0)
    return false;
  const char *name = access_path(path, server->token);
  return name && strcmp(name, "socket") == 0 && server->client_count < MAX_CLIENTS;
}

/* Tells each page whether it steers, and how many there are. */
static void post_roles(Server *server) {
  for (unsigned i = 0; i < server->client_count; i++) {
    const Client *client = server->clients[i];
    char text[160];
    text_set(text,
             "{\"type\":\"role\",\"client\":%u,\"steers\":%s,\"steering\":%s,\"pages\":%u}",
             client->id, client->steers ? "true" : "false",
             server->def.steering ? "true" : "false", server->client_count);
    server_post(server, client->id, text);
  }
}

static int begin(struct lws *wsi, Connection *connection) {
  Server *server = server_of(wsi);
  Client *client = calloc(1, sizeof *client);
  if (!client)
    return -1;
  client->wsi = wsi;
  client->last = &client->first;
  pthread_mutex_lock(&server->lock);
  bool room = server->client_count < MAX_CLIENTS;
  if (room) {
    client->id = ++server->next_id;
    client->steers = server->def.steering;
    for (unsigned i = 0; i < server->client_count; i++)
      client->steers &= !server->clients[i]->steers;
    server->clients[server->client_count++] = client;
  }
  unsigned count = server->client_count;
  pthread_mutex_unlock(&server->lock);
  if (!room) {
    free(client);
    return -1;
  }
  connection->client = client;
  post_roles(server);
  server->calls.greet(server->calls.user, client->id);
  server->calls.clients(server->calls.user, count);
  lws_callback_on_writable(wsi);
  return 0;
}

static void free_client(Client *client) {
  for (Text *text = client->first; text;) {
    Text *next = text->next;
    free(text);
    text = next;
  }
  frame_drop(client->shown);
  free(client->message);
  free(client->received);
  free(client);
}

static void end(struct lws *wsi, Connection *connection) {
  Server *server = server_of(wsi);
  Client *client = connection->client;
  connection->client = NULL;
  if (!client)
    return;
  pthread_mutex_lock(&server->lock);
  unsigned kept = 0;
  for (unsigned i = 0; i < server->client_count; i++)
    if (server->clients[i] != client)
      server->clients[kept++] = server->clients[i];
  server->client_count = kept;
  if (client->steers && kept) /* the page that has looked on for the longest time */
    server->clients[0]->steers = true;
  pthread_mutex_unlock(&server->lock);
  free_client(client);
  post_roles(server);
  server->calls.clients(server->calls.user, kept);
}

/* ---- refusing ---------------------------------------------------------------------------- */

/* Ends the connection when the next bytes can be sent: in the midst of a frame that waits for a
 * slow link, the reason would be lost. What arrives until then is not read. A reason has at
 * most 123 bytes of UTF-8. */
static int refuse(struct lws *wsi, Client *client, enum lws_close_status status,
                  const char *why) {
  size_t length = strlen(why);
  if (length > sizeof client->why - 1)
    length = sizeof client->why - 1;
  while (length > 0 && ((unsigned char)why[length] & 0xc0) == 0x80)
    length--;
  memcpy(client->why, why, length);
  client->why[length] = 0;
  client->refused = status;
  lws_callback_on_writable(wsi);
  return 0;
}

static int hang_up(struct lws *wsi, Client *client) {
  lws_close_reason(wsi, client->refused, (unsigned char *)client->why, strlen(client->why));
  return -1;
}

/* ---- sending ----------------------------------------------------------------------------- */

/* Whether there is something to send; the caller holds the lock. */
static bool has_work(const Server *server, const Client *client) {
  if (client->message || client->first)
    return true;
  bool late = client->waits_for && now_seconds() - client->sent > SEEN_TIMEOUT_SECONDS;
  return server->frame && server->frame != client->shown && (!client->waits_for || late);
}

static void wake_all(Server *server) {
  pthread_mutex_lock(&server->lock);
  for (unsigned i = 0; i < server->client_count; i++)
    if (has_work(server, server->clients[i]))
      lws_callback_on_writable(server->clients[i]->wsi);
  pthread_mutex_unlock(&server->lock);
}

/* Packs the newest frame. False: out of memory. */
static bool pack_frame(Server *server, Client *client) {
  pthread_mutex_lock(&server->lock);
  ViewFrame *frame = frame_keep(server->frame);
  pthread_mutex_unlock(&server->lock);
  client->message = frame_message(frame, client->shown, LWS_PRE, &client->message_size);
  client->message_sent = 0;
  client->waits_for = frame->serial;
  client->sent = now_seconds();
  frame_drop(client->shown);
  client->shown = frame;
  return client->message != NULL;
}

static bool send_fragment(struct lws *wsi, Client *client) {
  size_t left = client->message_size - client->message_sent,
         n = left < FRAGMENT ? left : FRAGMENT;
  bool first = client->message_sent == 0, last = n == left;
  enum lws_write_protocol kind = first ? LWS_WRITE_BINARY : LWS_WRITE_CONTINUATION;
  if (!last)
    kind |= LWS_WRITE_NO_FIN;
  /* the bytes before the fragment are sent already, so that the header of the fragment may
   * replace them */
  if (lws_write(wsi, client->message + LWS_PRE + client->message_sent, n, kind) < (int)n)
    return false;
  client->message_sent += n;
  if (!last)
    return true;
  free(client->message);
  client->message = NULL;
  return true;
}

static int send_next(struct lws *wsi, Connection *connection) {
  Client *client = connection->client;
  Server *server = server_of(wsi);
  if (!client)
    return -1;
  if (client->refused)
    return hang_up(wsi, client);
  bool good = true;
  Text *text = NULL;
  pthread_mutex_lock(&server->lock);
  bool work = has_work(server, client);
  if (!client->message && client->first) {
    text = client->first;
    client->first = text->next;
    if (!client->first)
      client->last = &client->first;
    client->texts--;
  }
  pthread_mutex_unlock(&server->lock);
  if (text)
    good = lws_write(wsi, text->bytes + LWS_PRE, text->size, LWS_WRITE_TEXT) >= (int)text->size;
  else if (work)
    good = (client->message || pack_frame(server, client)) && send_fragment(wsi, client);
  free(text);
  if (!good)
    return -1;
  pthread_mutex_lock(&server->lock);
  work = has_work(server, client);
  pthread_mutex_unlock(&server->lock);
  if (work)
    lws_callback_on_writable(wsi);
  return 0;
}

/* ---- receiving --------------------------------------------------------------------------- */

static void take_over(Server *server, Client *client) {
  pthread_mutex_lock(&server->lock);
  for (unsigned i = 0; i < server->client_count; i++)
    server->clients[i]->steers = server->def.steering && server->clients[i] == client;
  pthread_mutex_unlock(&server->lock);
  post_roles(server);
}

static int handle(struct lws *wsi, Client *client, const char *text, size_t size) {
  Server *server = server_of(wsi);
  static ViewMessage message; /* the server's thread alone uses it */
  char why[VL_GIVEN_MESSAGE];
  if (!message_parse(server->calls.types, text, size, &message, why))
    return refuse(wsi, client, LWS_CLOSE_STATUS_POLICY_VIOLATION, why);
  message.client = client->id;
  if (message.type->place == MESSAGE_SEEN) {
    if (message.serial == client->waits_for)
      client->waits_for = 0;
    lws_callback_on_writable(wsi);
  } else if (message.type->place == MESSAGE_STEER) {
    take_over(server, client);
  } else {
    server->calls.message(server->calls.user, client->steers, &message);
  }
  return 0;
}

static int receive(struct lws *wsi, Connection *connection, const char *in, size_t size) {
  Client *client = connection->client;
  if (!client)
    return -1;
  if (client->refused)
    return 0;
  if (lws_frame_is_binary(wsi))
    return refuse(wsi, client, LWS_CLOSE_STATUS_UNACCEPTABLE_OPCODE, "text is expected");
  if (client->received_size + size > MESSAGE_MAX_SIZE)
    return refuse(wsi, client, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, "too long");
  char *larger = realloc(client->received, client->received_size + size + 1);
  if (!larger)
    return -1;
  client->received = larger;
  memcpy(larger + client->received_size, in, size);
  client->received_size += size;
  if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi))
    return 0;
  size_t whole = client->received_size;
  client->received_size = 0;
  return handle(wsi, client, larger, whole);
}

int server_socket(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                  size_t size) {
  if (reason == LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION)
    return is_ours(wsi) ? 0 : -1;
  if (reason == LWS_CALLBACK_ESTABLISHED)
    return begin(wsi, user);
  if (reason == LWS_CALLBACK_CLOSED)
    end(wsi, user);
  if (reason == LWS_CALLBACK_SERVER_WRITEABLE)
    return send_next(wsi, user);
  if (reason == LWS_CALLBACK_RECEIVE)
    return receive(wsi, user, in, size);
  if (reason == LWS_CALLBACK_EVENT_WAIT_CANCELLED)
    wake_all(server_of(wsi));
  return 0;
}
