/* view/server_http.c: the server's answers to HTTP requests: the files of the page. */
#include <string.h>

#include "cli/macros.h"
#include "view/server_parts.h"
#include "view/web_files.h"

/* A connection: the file that is being sent. */
typedef struct Download {
  const WebFile *file;
  size_t sent;
} Download;

const size_t server_http_bytes = sizeof(Download);

/* Headers of all answers: the page loads nothing from elsewhere, is in no frame, and tells
 * nobody its address. */
static bool add_headers(struct lws *wsi, unsigned char **p, unsigned char *end) {
  static const char *const headers[][2] = {
      {"cache-control:", "no-store"},
      {"x-content-type-options:", "nosniff"},
      {"x-frame-options:", "DENY"},
      {"referrer-policy:", "no-referrer"},
      {"cross-origin-resource-policy:", "same-origin"},
      {"content-security-policy:",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
       "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"}};
  for (size_t i = 0; i < LENGTH(headers); i++)
    if (lws_add_http_header_by_name(wsi, (const unsigned char *)headers[i][0],
                                    (const unsigned char *)headers[i][1],
                                    (int)strlen(headers[i][1]), p, end))
      return false;
  return true;
}

static int refuse(struct lws *wsi, unsigned code) {
  return lws_return_http_status(wsi, code, NULL) ? -1
         : lws_http_transaction_completed(wsi)   ? -1
                                                 : 0;
}

static int answer(struct lws *wsi, Download *download, const char *path) {
  const Server *server = lws_context_user(lws_get_context(wsi));
  unsigned char buffer[LWS_PRE + 2048], *p = buffer + LWS_PRE,
                                        *end = buffer + sizeof buffer - 1;
  char host[256];
  if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0)
    return refuse(wsi, HTTP_STATUS_METHOD_NOT_ALLOWED);
  if (!server_check_host(wsi, server, host, sizeof host))
    return refuse(wsi, HTTP_STATUS_FORBIDDEN);
  const char *name = access_path(path, server->token);
  if (!name)
    return refuse(wsi, HTTP_STATUS_FORBIDDEN);
  const WebFile *file = web_file_find(*name ? name : server->def.home);
  if (!file)
    return refuse(wsi, HTTP_STATUS_NOT_FOUND);
  if (lws_add_http_common_headers(wsi, HTTP_STATUS_OK, file->type, file->size, &p, end) ||
      !add_headers(wsi, &p, end) ||
      lws_finalize_write_http_header(wsi, buffer + LWS_PRE, &p, end))
    return -1;
  *download = (Download){.file = file};
  lws_callback_on_writable(wsi);
  return 0;
}

static int send_portion(struct lws *wsi, Download *download) {
  if (!download || !download->file)
    return 0;
  unsigned char buffer[LWS_PRE + PORTION];
  size_t left = download->file->size - download->sent, n = left < PORTION ? left : PORTION;
  memcpy(buffer + LWS_PRE, download->file->data + download->sent, n);
  bool last = n == left;
  if (lws_write(wsi, buffer + LWS_PRE, n, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) !=
      (int)n)
    return -1;
  download->sent += n;
  if (!last) {
    lws_callback_on_writable(wsi);
    return 0;
  }
  download->file = NULL;
  return lws_http_transaction_completed(wsi) ? -1 : 0;
}

int server_http(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                size_t size) {
  if (reason == LWS_CALLBACK_HTTP)
    return answer(wsi, user, in);
  if (reason == LWS_CALLBACK_HTTP_WRITEABLE)
    return send_portion(wsi, user);
  /* a WebSocket without the page's protocol */
  if (reason == LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION)
    return -1;
  return lws_callback_http_dummy(wsi, reason, user, in, size);
}
