// launchdyn live: the page that simulates, in a browser of this machine, with launches by this one.
#include <stdio.h>
#include <time.h>

#include "cli/command.h"
#include "cli/live_server.h"
#include "cli/progress.h"
#include "launchdyn/live.h"

// Until a signal asks for an end.
static void wait_for_end(void)
{
    while (!progress_signal())
        nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL);
}

static int serve(ld_live *live, int port)
{
    run_progress progress;
    ld_error error;
    progress_start(&progress, true);
    ld_status status = live_server_start(live, port, &error);
    if (status)
        return command_fail(status, &error);
    puts(live_server_address());
    fflush(stdout);
    if (!command_is_quiet())
        command_complain("open this address in a browser of this machine; Ctrl-C ends");
    wait_for_end();
    ld_live_stop(live);
    live_server_end();
    return command_code(LD_ERR_INTERRUPTED);
}

static int serve_file(const char *file, char **sets, int port)
{
    ld_live *live;
    ld_error error;
    size_t count = 0;
    while (sets && sets[count])
        count++;
    if (port < 0 || port > 65535) {
        command_complain("--port: expected a number from 0 to 65535, found %d", port);
        return EXIT_INPUT;
    }
    ld_status status = ld_live_create(file, (const char *const *)sets, count, &live, &error);
    if (status)
        return command_fail(status, &error);
    int code = serve(live, port);
    ld_live_free(live);
    return code;
}

int command_live(const command *self, int argc, char **argv)
{
    char **sets = NULL;
    int port = 0, code = 0;
    const command_option options[] = {
        COMMAND_SETS(&sets),
        {"port", '\0', OPTION_INTEGER, &port, "Listen on this port of 127.0.0.1 (a free one)", "N"},
        COMMAND_USUAL};
    command_line line;
    if (command_line_read(&line, self, argc, argv, options, &code)) {
        code = serve_file(line.word[0], sets, port);
        options_end(&line);
    }
    return code;
}
