#include "cli/live_server.h"

#include <civetweb.h>
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

enum { TOKEN_BYTES = 16, TOKEN_LETTERS = 2 * TOKEN_BYTES, MOST_POSTED = 1 << 24 };

// What is called of civetweb, by its own names.
static struct {
    __typeof__(&mg_start2) start2;
    __typeof__(&mg_get_server_ports) get_server_ports;
    __typeof__(&mg_get_request_info) get_request_info;
    __typeof__(&mg_read) read;
    __typeof__(&mg_write) write;
} http;

typedef struct live_server {
    struct mg_context *context;
    ld_live *live;
    pthread_mutex_t lock;
    pthread_cond_t left;
    int inside; // answers on their way
    bool ended;
    char token[TOKEN_LETTERS + 1];
    char address[TOKEN_LETTERS + 48];
} live_server;

static live_server only; // of the process; it has no end of its own: mg_stop() takes two seconds

// ---- answers ----

typedef struct answering {
    const live_server *server;
    struct mg_connection *connection;
    const struct mg_request_info *asked;
    int code; // of the answer
} answering;

// Nothing is kept, framed, guessed at or told to others.
static int respond(const answering *self, const char *status, const char *type, const char *body,
                   size_t length)
{
    char head[512];
    int size = snprintf(
        head, sizeof head,
        "HTTP/1.1 %s\r\nContent-Type: %s; charset=utf-8\r\nContent-Length: %zu\r\nConnection: "
        "close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: "
        "no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: "
        "same-origin\r\nContent-Security-Policy: frame-ancestors 'none'\r\n\r\n",
        status, type, length);
    if (http.write(self->connection, head, (size_t)size) == size)
        http.write(self->connection, body, length);
    return atoi(status);
}

static int refuse(const answering *self, const char *status, const char *why)
{
    char text[LD_ERROR_TEXT + 2];
    int length = snprintf(text, sizeof text, "%s\n", why);
    return respond(self, status, "text/plain", text, (size_t)length);
}

static int refuse_for(const answering *self, ld_status status, const ld_error *error)
{
    return refuse(self,
                  status == LD_ERR_INPUT         ? "400 Bad Request"
                  : status == LD_ERR_INTERRUPTED ? "503 Service Unavailable"
                                                 : "500 Internal Server Error",
                  error->text);
}

// The page; where a scenario was posted, what follows from it.
static ld_status write_answer(const answering *self, const char *posted, size_t size, FILE *stream,
                              ld_error *error)
{
    return posted ? ld_live_launch(self->server->live, posted, size, stream, error)
                  : ld_live_page(self->server->live, stream, error);
}

// `posted` NULL: nothing was.
static int send_answer(const answering *self, const char *posted, size_t size)
{
    char *text = NULL;
    size_t length = 0;
    ld_error error;
    FILE *stream = open_memstream(&text, &length);
    ld_status status = stream ? write_answer(self, posted, size, stream, &error)
                              : ld_fail(&error, LD_ERR_MEMORY, "no memory for the answer");
    if (stream && fclose(stream) != 0 && !status)
        status = ld_fail(&error, LD_ERR_MEMORY, "no memory for the answer");
    int code = status ? refuse_for(self, status, &error)
                      : respond(self, "200 OK", posted ? "text/plain" : "text/html", text, length);
    free(text);
    return code;
}

static int take_launch(const answering *self)
{
    long long size = self->asked->content_length, got = 0;
    if (size < 0)
        return refuse(self, "411 Length Required", "expected a request with a Content-Length");
    if (size > MOST_POSTED)
        return refuse(self, "413 Payload Too Large",
                      "the scenario with its files has more than 16 MiB");
    char *posted = malloc((size_t)size + 1);
    if (!posted)
        return refuse(self, "500 Internal Server Error", "no memory for a launch");
    for (int part = 1; got < size && part > 0; got += part > 0 ? part : 0)
        part = http.read(self->connection, posted + got, (size_t)(size - got));
    int code = got == size
                   ? send_answer(self, posted, (size_t)size)
                   : refuse(self, "400 Bad Request", "the request has ended before its length");
    free(posted);
    return code;
}

// ---- who may ask ----

// Whether each header of that name says that the request is to this server: its host, behind
// `before`.
static bool is_ours(const answering *self, const char *name, const char *before, bool required)
{
    const struct mg_request_info *asked = self->asked;
    bool found = false;
    char address[64], local[64];
    snprintf(address, sizeof address, "%s127.0.0.1:%d", before, asked->server_port);
    snprintf(local, sizeof local, "%slocalhost:%d", before, asked->server_port);
    for (int i = 0; i < asked->num_headers; i++) {
        const char *value = asked->http_headers[i].value;
        if (strcasecmp(asked->http_headers[i].name, name) != 0)
            continue;
        if (strcmp(value, address) != 0 && strcmp(value, local) != 0)
            return false;
        found = true;
    }
    return found || !required;
}

// What is asked for behind "/TOKEN/"; NULL: without the token. It takes as long for all tokens.
static const char *behind_token(const answering *self)
{
    const char *asked = self->asked->local_uri, *token = self->server->token;
    unsigned differ = 0;
    if (!asked || strlen(asked) < TOKEN_LETTERS + 2)
        return NULL;
    for (int i = 0; i < TOKEN_LETTERS; i++)
        differ |= (unsigned)(asked[1 + i] ^ token[i]);
    differ |= (unsigned)(asked[0] ^ '/') | (unsigned)(asked[1 + TOKEN_LETTERS] ^ '/');
    return differ ? NULL : asked + TOKEN_LETTERS + 2;
}

static int answer_as_is(const answering *self)
{
    const char *wanted = behind_token(self), *method = self->asked->request_method;
    if (!wanted || !is_ours(self, "Host", "", true) || !is_ours(self, "Origin", "http://", false))
        return refuse(self, "403 Forbidden", "use the address that launchdyn live has printed");
    if (strcmp(wanted, "") == 0 && strcmp(method, "GET") == 0)
        return send_answer(self, NULL, 0);
    if (strcmp(wanted, "launch") == 0 && strcmp(method, "POST") == 0)
        return take_launch(self);
    return refuse(self, "404 Not Found", "here are the page and its launches");
}

static void *answer_in_thread(void *data)
{
    answering *self = data;
    self->code = answer_as_is(self);
    return NULL;
}

// Whether there are answers still; then live_server_end() waits for this one.
static bool enter(live_server *self)
{
    pthread_mutex_lock(&self->lock);
    bool open = !self->ended;
    self->inside += open;
    pthread_mutex_unlock(&self->lock);
    return open;
}

static void leave(live_server *self)
{
    pthread_mutex_lock(&self->lock);
    self->inside--;
    pthread_cond_signal(&self->left);
    pthread_mutex_unlock(&self->lock);
}

// For civetweb, whose threads have less stack than a launch needs: answers every request, whatever
// it is.
static int answer(struct mg_connection *connection)
{
    pthread_t thread;
    const struct mg_request_info *asked = http.get_request_info(connection);
    live_server *server = asked->user_data;
    answering self = {.server = server, .connection = connection, .asked = asked};
    if (!enter(server))
        return refuse(&self, "503 Service Unavailable", "launchdyn live has ended");
    if (pthread_create(&thread, NULL, answer_in_thread, &self) == 0)
        pthread_join(thread, NULL);
    else
        self.code = refuse(&self, "500 Internal Server Error", "no thread for an answer");
    leave(server);
    return self.code;
}

// ---- start and end ----

// Why it cannot listen is said while it starts, in the thread that does; nothing is printed.
static _Thread_local char said[LD_ERROR_TEXT];

static int keep_message(const struct mg_connection *connection, const char *message)
{
    (void)connection;
    if (!*said)
        snprintf(said, sizeof said, "%s", message);
    return 1;
}

static ld_status load(ld_error *error)
{
    static const char file[] = "libcivetweb.so.1";
    void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return ld_fail(error, LD_ERR_MISSING,
                       "civetweb cannot be loaded: install it (Debian: apt install "
                       "libcivetweb1): %s",
                       dlerror());
#define LOAD(name)                                                                                 \
    if (!(http.name = (__extension__(__typeof__(http.name)) dlsym(library, "mg_" #name))))         \
    return ld_fail(error, LD_ERR_MISSING, "%s lacks mg_" #name, file)
    LOAD(start2);
    LOAD(get_server_ports);
    LOAD(get_request_info);
    LOAD(read);
    LOAD(write);
    return LD_OK;
}

static ld_status make_token(char *token, ld_error *error)
{
    unsigned char byte[TOKEN_BYTES];
    if (getrandom(byte, sizeof byte, 0) != sizeof byte)
        return ld_fail(error, LD_ERR_MISSING, "no random numbers for a token: %s", strerror(errno));
    for (int i = 0; i < TOKEN_BYTES; i++)
        snprintf(token + 2 * i, 3, "%02x", byte[i]);
    return LD_OK;
}

static ld_status listen_on(live_server *self, int port, ld_error *error)
{
    char where[32], text[LD_ERROR_TEXT] = "";
    struct mg_server_port bound[1] = {{0}};
    snprintf(where, sizeof where, "127.0.0.1:%d", port);
    const char *options[] = {
        "listening_ports",    where,   "num_threads", "4", "enable_keep_alive", "no",
        "request_timeout_ms", "10000", NULL};
    const struct mg_callbacks callbacks = {.begin_request = answer, .log_message = keep_message};
    struct mg_init_data init = {&callbacks, self, options};
    struct mg_error_data why = {.text = text, .text_buffer_size = sizeof text};
    self->context = http.start2(&init, &why);
    if (!self->context || http.get_server_ports(self->context, 1, bound) != 1)
        return ld_fail(error, LD_ERR_MISSING, "%s", *said ? said : text);
    snprintf(self->address, sizeof self->address, "http://127.0.0.1:%d/%s/", bound[0].port,
             self->token);
    return LD_OK;
}

ld_status live_server_start(ld_live *live, int port, ld_error *error)
{
    only.live = live;
    pthread_mutex_init(&only.lock, NULL);
    pthread_cond_init(&only.left, NULL);
    ld_status status = load(error);
    if (!status)
        status = make_token(only.token, error);
    return status ? status : listen_on(&only, port, error);
}

const char *live_server_address(void)
{
    return only.address;
}

void live_server_end(void)
{
    pthread_mutex_lock(&only.lock);
    only.ended = true;
    while (only.inside > 0)
        pthread_cond_wait(&only.left, &only.lock);
    pthread_mutex_unlock(&only.lock);
}
