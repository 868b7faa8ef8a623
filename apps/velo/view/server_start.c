/* view/server_start.c: starts and ends the server, and takes what is sent; see server.h. */
#include "cli/macros.h"
#include "view/server.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/report.h"
#include "view/private_file.h"
#include "view/server_parts.h"

bool server_check_host(struct lws *wsi, const Server *server, char *host, size_t size) {
  return lws_hdr_copy(wsi, host, (int)size, WSI_TOKEN_HOST) > 0 &&
         access_host(host, server->listen[0] ? server->listen : NULL);
}

static void *serve(void *user) {
  Server *server = user;
  while (!server->quit && lws_service(server->lws, 0) >= 0) {
    struct timespec now;
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0)
      server->seconds = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
  }
  return NULL;
}

static int open_port(Server *server) {
  static const lws_retry_bo_t alive = {.secs_since_valid_ping = 10,
                                       .secs_since_valid_hangup = 30};
  struct lws_protocols protocols[] = {
      {"http", server_http, server_http_bytes, 0, 0, NULL, 0},
      {"velo-view", server_socket, server_socket_bytes, 4096, 0, NULL, 0},
      {NULL, NULL, 0, 0, 0, NULL, 0}};
  static struct lws_protocols kept[3];
  memcpy(kept, protocols, sizeof kept);
  struct lws_context_creation_info info = {.port = CONTEXT_PORT_NO_LISTEN_SERVER,
                                           .protocols = kept,
                                           .gid = (gid_t)-1,
                                           .uid = (uid_t)-1,
                                           .user = server,
                                           .pt_serv_buf_size = 32 * 1024,
                                           .retry_and_idle_policy = &alive,
                                           .keepalive_timeout = 5,
                                           .options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS};
  lws_set_log_level(0, NULL);
  server->lws = lws_create_context(&info);
  if (!server->lws)
    return report_failure(STATUS_OTHER, "the server cannot be started");
  info.port = server->def.port;
  info.iface = server->listen[0] ? server->listen : "127.0.0.1";
  info.vhost_name = "velo";
  if (strcmp(info.iface, "0.0.0.0") == 0) {
    info.iface = NULL;
    info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  }
  if (info.iface && strcmp(info.iface, "::") == 0)
    info.iface = NULL;
  if (info.iface && !strchr(info.iface, ':'))
    info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
  server->vhost = lws_create_vhost(server->lws, &info);
  if (server->vhost)
    server->port = lws_get_vhost_listen_port(server->vhost);
  if (server->vhost && server->port > 0)
    return -1;
  return report_failure(STATUS_IO, "cannot listen on %s port %d: is another program using it?",
                        info.iface ? info.iface : server->listen, server->def.port);
}

int server_open(const ServerDef *def, Server **result) {
  *result = NULL;
  Server *server = calloc(1, sizeof *server);
  if (!server)
    return report_no_memory();
  server->def = *def;
  if (def->address)
    text_set(server->listen, "%s", def->address);
  pthread_mutex_init(&server->lock, NULL);
  int status = access_make_token(server->token)
                   ? -1
                   : report_failure(STATUS_OTHER, "the system gives no random numbers");
  if (def->port && !def->address)
    private_file_token(def->port, server->token);
  if (status < 0)
    status = open_port(server);
  if (status < 0) {
    bool all = strcmp(server->listen, "0.0.0.0") == 0 || strcmp(server->listen, "::") == 0;
    const char *name = server->listen[0] && !all ? server->listen : "127.0.0.1";
    bool six = strchr(name, ':') != NULL;
    text_set(server->address, "http://%s%s%s:%d/%s/%s", six ? "[" : "", name, six ? "]" : "",
             server->port, server->token, def->query);
    *result = server;
    return -1;
  }
  if (server->lws)
    lws_context_destroy(server->lws);
  pthread_mutex_destroy(&server->lock);
  free(server);
  return status;
}

int server_start(Server *server, const ServerCalls *calls) {
  server->calls = *calls;
  server->started = pthread_create(&server->thread, NULL, serve, server) == 0;
  return server->started ? -1
                         : report_failure(STATUS_OTHER, "the system refuses to start a thread");
}

void server_stop(Server *server) {
  if (!server)
    return;
  server->quit = true;
  lws_cancel_service(server->lws);
  if (server->started)
    pthread_join(server->thread, NULL);
  lws_context_destroy(server->lws);
  frame_drop(server->frame);
  pthread_mutex_destroy(&server->lock);
  free(server);
}

const char *server_address(const Server *server) {
  return server->address;
}

int server_port(const Server *server) {
  return server->port;
}

double server_seconds(const Server *server) {
  return server->seconds;
}

/* Whether two texts are of the same type, which is their first member. */
static bool same_type(const Text *a, const Text *b) {
  return a->type_size == b->type_size &&
         memcmp(a->bytes + LWS_PRE, b->bytes + LWS_PRE, a->type_size) == 0;
}

/* Drops the oldest text behind which one of its type waits: the last of each type always
 * arrives. Types are fewer than MAX_TEXTS. */
static void drop_outdated(Client *client) {
  for (Text **at = &client->first; *at; at = &(*at)->next) {
    Text *old = *at;
    const Text *newer = old->next;
    while (newer && !same_type(old, newer))
      newer = newer->next;
    if (!newer)
      continue;
    *at = old->next;
    free(old);
    client->texts--;
    return;
  }
}

static void add_text(Client *client, const char *text) {
  size_t size = strlen(text);
  Text *made = malloc(sizeof *made + LWS_PRE + size);
  if (!made)
    return;
  made->next = NULL;
  made->size = size;
  made->type_size = strcspn(text, ",}");
  memcpy(made->bytes + LWS_PRE, text, size);
  *client->last = made;
  client->last = &made->next;
  client->texts++;
  if (client->texts > MAX_TEXTS)
    drop_outdated(client);
}

void server_post(Server *server, uint32_t client, const char *text) {
  pthread_mutex_lock(&server->lock);
  for (unsigned i = 0; i < server->client_count; i++)
    if (!client || server->clients[i]->id == client)
      add_text(server->clients[i], text);
  pthread_mutex_unlock(&server->lock);
  lws_cancel_service(server->lws);
}

void server_show(Server *server, ViewFrame *frame) {
  pthread_mutex_lock(&server->lock);
  frame_drop(server->frame);
  server->frame = frame_keep(frame);
  pthread_mutex_unlock(&server->lock);
  lws_cancel_service(server->lws);
}
