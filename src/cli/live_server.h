// The server of launchdyn live, by civetweb, whose library is loaded here: on loopback alone, for
// who knows the token in its address.
#ifndef LD_CLI_LIVE_SERVER_H
#define LD_CLI_LIVE_SERVER_H

#include "launchdyn/live.h"

// Serves the page from now on, one in a process. `port` 0: a free one. LD_ERR_MISSING: no civetweb,
// or the port cannot be had.
ld_status live_server_start(ld_live *live, int port, ld_error *error);

// "http://127.0.0.1:PORT/TOKEN/"
const char *live_server_address(void);

// Waits for the answers that are on their way, and gives no more: then the page may go. Threads and
// port go with the process.
void live_server_end(void);

#endif
