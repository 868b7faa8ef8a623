/* view/access.h: who may speak to the server: the token, and the checks of Host and Origin that
 * keep other sites' pages out (DNS rebinding, cross-site requests). */
#ifndef APP_VIEW_ACCESS_H
#define APP_VIEW_ACCESS_H

#include <stdbool.h>

enum { TOKEN_SIZE = 33 }; /* 128 random bits as text, with the zero */

/* False: the system gives no random numbers. */
bool access_make_token(char token[TOKEN_SIZE]);
/* The part of a path behind "/TOKEN/"; null: the token is wrong. Takes the same time for every
 * wrong token. */
const char *access_path(const char *path, const char *token);
/* Whether the Host header names this machine: 127.0.0.1, localhost, [::1], or the address that
 * was given to listen on. For an address that means all interfaces: any address in numbers, or
 * this machine's name. */
bool access_host(const char *host, const char *listen);
/* Whether the Origin header is the page's own: http://HOST. */
bool access_origin(const char *origin, const char *host);

#endif
