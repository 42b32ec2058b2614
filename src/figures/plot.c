// Drawing figures: from folders of results through gnuplot to a picture.
#include "figures/plot.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/part_file.h"
#include "figures/scene.h"
#include "results/manifest.h"

enum { MOST_FIGURES = 32 };

extern char **environ;

static ld_status unknown_figure(const char *name, ld_error *error)
{
    const char *names[MOST_FIGURES];
    char list[512] = "";
    size_t count = 0;
    for (const ld_figure *figure; (figure = ld_figure_at(count)) != NULL; count++) {
        names[count] = figure->name;
        size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", count ? ", " : "", figure->name);
    }
    const char *nearest = ld_nearest_name(name, names, count);
    return ld_fail(error, LD_ERR_INPUT, "unknown figure \"%.40s\"%s%s%s; expected one of %s", name,
                   nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "",
                   list);
}

ld_status plot_format_of(const char *file, plot_format *format, ld_error *error)
{
    static const char *const endings[] = {
        [PLOT_SVG] = ".svg", [PLOT_PDF] = ".pdf", [PLOT_PNG] = ".png"};
    const char *ending = strrchr(file, '.');
    for (int i = 0; ending && i < 3; i++)
        if (strcasecmp(ending, endings[i]) == 0) {
            *format = (plot_format)i;
            return LD_OK;
        }
    return ld_fail(error, LD_ERR_INPUT,
                   "expected a picture's name that ends in .svg, .pdf or .png, found %.200s", file);
}

// ---- gnuplot ----

// The last line that gnuplot printed, its complaint.
static void read_complaint(FILE *printed, char *complaint, size_t size)
{
    char line[256];
    snprintf(complaint, size, "it gives no reason");
    rewind(printed);
    while (fgets(line, sizeof line, printed)) {
        line[strcspn(line, "\n")] = '\0';
        if (line[strspn(line, " \t^")])
            snprintf(complaint, size, "%s", line + strspn(line, " \t"));
    }
}

// What gnuplot reads, draws and complains to. Returns 0 or the number of what went wrong.
static int connect_gnuplot(posix_spawn_file_actions_t *actions, int script, int drawn, int printed)
{
    int problem = posix_spawn_file_actions_adddup2(actions, script, STDIN_FILENO);
    if (!problem)
        problem = posix_spawn_file_actions_adddup2(actions, drawn, STDOUT_FILENO);
    if (!problem)
        problem = posix_spawn_file_actions_adddup2(actions, printed, STDERR_FILENO);
    return problem;
}

// Starts gnuplot from PATH, without a shell and without the user's settings; what it draws goes to
// `drawn`. A cut pipe and a limit of files do to it what they do by default.
static int start_gnuplot(FILE *script, int drawn, FILE *printed, pid_t *child)
{
    char *arguments[] = {"gnuplot", "--default-settings", NULL};
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGPIPE);
    sigaddset(&signals, SIGXFSZ);
    int problem = posix_spawnattr_init(&attributes);
    if (problem)
        return problem;
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    problem = posix_spawn_file_actions_init(&actions);
    if (!problem) {
        problem = connect_gnuplot(&actions, fileno(script), drawn, fileno(printed));
        if (!problem)
            problem = posix_spawnp(child, arguments[0], &actions, &attributes, arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    posix_spawnattr_destroy(&attributes);
    return problem;
}

// Writes what comes from gnuplot, which itself would not see that a disk is full. Reads on to the
// end in any case. Returns 0 or the number of what went wrong.
static int take_picture(int drawn, FILE *picture)
{
    char bytes[1 << 14];
    int problem = 0;
    ssize_t count;
    while ((count = read(drawn, bytes, sizeof bytes)) > 0 || (count < 0 && errno == EINTR))
        if (count > 0 && !problem && fwrite(bytes, 1, (size_t)count, picture) < (size_t)count)
            problem = errno;
    if (count < 0 && !problem)
        problem = errno;
    return problem;
}

static ld_status run_gnuplot(FILE *script, FILE *printed, FILE *picture, const char *file,
                             ld_error *error)
{
    int drawn[2], code = 0;
    pid_t child = 0;
    if (pipe(drawn) != 0)
        return ld_fail(error, LD_ERR_FILE, "cannot make a pipe: %s", strerror(errno));
    fcntl(drawn[0], F_SETFD, FD_CLOEXEC);
    fcntl(drawn[1], F_SETFD, FD_CLOEXEC);
    int problem = start_gnuplot(script, drawn[1], printed, &child);
    close(drawn[1]);
    int unwritten = problem ? 0 : take_picture(drawn[0], picture);
    close(drawn[0]);
    if (problem == ENOENT)
        return ld_fail(error, LD_ERR_MISSING,
                       "gnuplot not found: install it (Debian: apt install gnuplot-nox)");
    if (problem)
        return ld_fail(error, LD_ERR_MISSING, "cannot run gnuplot: %s", strerror(problem));
    while (waitpid(child, &code, 0) < 0 && errno == EINTR)
        ;
    if (unwritten)
        return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: %s", file, strerror(unwritten));
    if (code == 0)
        return LD_OK;
    char complaint[256];
    read_complaint(printed, complaint, sizeof complaint);
    return ld_fail(error, LD_ERR_FILE, "gnuplot failed: %s", complaint);
}

static ld_status draw(plot_writer *write, const void *page, plot_format format, FILE *picture,
                      const char *file, ld_error *error)
{
    FILE *script = tmpfile(), *printed = tmpfile();
    ld_status status = LD_OK;
    if (!script || !printed)
        status = ld_fail(error, LD_ERR_FILE, "cannot make a temporary file: %s", strerror(errno));
    if (!status)
        status = write(script, page, format, error);
    if (!status && (fflush(script) != 0 || ferror(script) || lseek(fileno(script), 0, SEEK_SET)))
        status = ld_fail(error, LD_ERR_FILE, "cannot write a temporary file: %s", strerror(errno));
    if (!status)
        status = run_gnuplot(script, printed, picture, file, error);
    if (script)
        fclose(script);
    if (printed)
        fclose(printed);
    return status;
}

static ld_status draw_part(plot_writer *write, const void *page, plot_format format,
                           const part_file *part, ld_error *error)
{
    FILE *picture = fopen(part->path, "wb");
    if (!picture)
        return part_file_failed(part, errno, error);
    ld_status status = draw(write, page, format, picture, part->name, error);
    if (fclose(picture) != 0 && !status)
        status = part_file_failed(part, errno, error);
    return status;
}

// Under a temporary name beside the picture, which then gets its own.
ld_status plot_draw(plot_writer *write, const void *page, plot_format format, const char *file,
                    ld_error *error)
{
    part_file part;
    ld_status status = part_file_begin(&part, file, error);
    if (status)
        return status;
    status = draw_part(write, page, format, &part, error);
    return part_file_end(&part, status, error);
}

// ---- the page ----

static ld_status no_history(const char *folder, ld_error *error)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/study.db", folder);
    if (access(path, F_OK) == 0)
        return ld_fail(
            error, LD_ERR_INPUT,
            "%.400s contains a study: launchdyn study plot %.400s draws its results over "
            "swept keys, launchdyn report %.400s its scatter",
            folder, folder, folder);
    return ld_fail(error, LD_ERR_INPUT, "no results in %.400s: there is no history.h5", folder);
}

// `note` (NULL: not requested) takes the first doubt.
static ld_status read_folder(const char *folder, char *note, history_data *history, ld_error *error)
{
    char path[4096], doubt[256];
    snprintf(path, sizeof path, "%s/history.h5", folder);
    if (access(path, F_OK) != 0)
        return no_history(folder, error);
    ld_status status = manifest_check_history(folder, doubt, sizeof doubt, error);
    if (!status && note && *doubt && !*note)
        snprintf(note, LD_ERROR_TEXT, "%.300s: %s", folder, doubt);
    return status ? status : history_read(path, history, error);
}

// Runs are known by their titles where these differ, else by their folders.
static void name_runs(const ld_picture *picture, const history_data *run, const char **name)
{
    bool differ = true;
    for (size_t i = 0; i < picture->folder_count; i++) {
        name[i] = run[i].title;
        differ = differ && name[i];
        for (size_t j = 0; differ && j < i; j++)
            differ = strcmp(name[i], name[j]) != 0;
    }
    if (!differ)
        memcpy(name, picture->folder, picture->folder_count * sizeof *name);
}

static ld_status add_figure(const plot_figure **figure, size_t *count, const plot_figure *added,
                            ld_error *error)
{
    if (*count == MOST_FIGURES)
        return ld_fail(error, LD_ERR_INPUT, "at most %d figures fit on a page", MOST_FIGURES);
    figure[(*count)++] = added;
    return LD_OK;
}

// All figures for which some run has a column.
static ld_status add_all(const plot_figure **figure, size_t *count, const history_data *run,
                         size_t runs, ld_error *error)
{
    ld_status status = LD_OK;
    const ld_figure *about;
    for (size_t i = 0; !status && (about = ld_figure_at(i)) != NULL; i++) {
        const plot_figure *found = plot_figure_find(about->name);
        bool has = false;
        for (size_t j = 0; j < runs; j++)
            has = has || plot_figure_has_columns(found, &run[j]);
        if (has)
            status = add_figure(figure, count, found, error);
    }
    return status;
}

// What is drawn where no figure is named: the launch, or a flight alone.
static ld_status add_usual(const plot_figure **figure, size_t *count, const history_data *run,
                           ld_error *error)
{
    static const char *const of_launch[] = {"tip", "contact", "relative", NULL};
    static const char *const of_flight[] = {"trajectory", "flight", NULL};
    bool alone = run->flights > 0 && !plot_figure_has_columns(plot_figure_find("tip"), run);
    ld_status status = LD_OK;
    for (const char *const *name = alone ? of_flight : of_launch; *name && !status; name++)
        status = add_figure(figure, count, plot_figure_find(*name), error);
    return status;
}

static ld_status draw_runs(const ld_picture *picture, const history_data *run, plot_format format,
                           const char *file, ld_error *error)
{
    const plot_style *style = plot_style_find(picture->style, error);
    const plot_figure *figure[MOST_FIGURES];
    const char *name[PLOT_RUNS];
    size_t count = 0;
    ld_status status = style ? LD_OK : LD_ERR_INPUT;
    if (!status && picture->figure_count == 0)
        status = add_usual(figure, &count, run, error);
    for (size_t i = 0; i < picture->figure_count && !status; i++)
        if (strcmp(picture->figure[i], "all") == 0)
            status = add_all(figure, &count, run, picture->folder_count, error);
        else
            status = add_figure(figure, &count, plot_figure_find(picture->figure[i]), error);
    if (!status && count == 0)
        status = ld_fail(error, LD_ERR_INPUT, "no figure shows a column of these results");
    if (status)
        return status;
    name_runs(picture, run, name);
    plot_page page = {.run = run,
                      .name = name,
                      .runs = picture->folder_count,
                      .figure = figure,
                      .figures = count,
                      .from = picture->from,
                      .to = picture->to,
                      .style = style,
                      .width = plot_width(style, picture->width)};
    return plot_draw(plot_write_script, &page, format, file, error);
}

static ld_status check_picture(const ld_picture *picture, ld_error *error)
{
    if (picture->folder_count == 0 || picture->folder_count > PLOT_RUNS)
        return ld_fail(error, LD_ERR_INPUT, "expected 1 to %d folders with results", PLOT_RUNS);
    for (size_t i = 0; i < picture->figure_count; i++)
        if (strcmp(picture->figure[i], "all") != 0 && !plot_figure_find(picture->figure[i]))
            return unknown_figure(picture->figure[i], error);
    if (!plot_style_find(picture->style, error))
        return LD_ERR_INPUT;
    if (picture->width != 0 && !(picture->width >= 0.05 && picture->width <= 0.5))
        return ld_fail(error, LD_ERR_INPUT, "found a width of %g mm, expected 50 mm to 500 mm",
                       picture->width * 1e3);
    if (picture->from >= picture->to)
        return ld_fail(error, LD_ERR_INPUT, "there is nothing to draw from %g ms to %g ms",
                       picture->from * 1e3, picture->to * 1e3);
    return LD_OK;
}

// ---- scenes ----

static bool is_scene(const char *file)
{
    const char *ending = strrchr(file, '.');
    return ending && strcasecmp(ending, ".glb") == 0;
}

static ld_status check_scene(const ld_picture *picture, ld_error *error)
{
    if (picture->folder_count != 1)
        return ld_fail(error, LD_ERR_INPUT, "a scene shows one run, found %zu folders",
                       picture->folder_count);
    if (picture->figure_count > 0 || picture->style || picture->width != 0)
        return ld_fail(error, LD_ERR_INPUT, "figures, style and width are not for a scene (.glb)");
    for (int i = 0; i < 2 && picture->scene; i++) {
        double times = i ? picture->scene->slower : picture->scene->magnify;
        if (!(times > 0 && times <= 1e5))
            return ld_fail(error, LD_ERR_INPUT, "found %s %g, expected more than 0, at most 100000",
                           i ? "slower" : "magnify", times);
    }
    return LD_OK;
}

static ld_status write_scene(const ld_picture *picture, const history_data *run, const char *file,
                             ld_error *error)
{
    part_file part;
    ld_status status = part_file_begin(&part, file, error);
    if (status)
        return status;
    FILE *to = fopen(part.path, "wb");
    if (!to)
        return part_file_end(&part, part_file_failed(&part, errno, error), error);
    status = scene_write(run, picture, to, error);
    bool failed = ferror(to) != 0;
    if ((fclose(to) != 0 || failed) && !status)
        status = part_file_failed(&part, errno, error);
    return part_file_end(&part, status, error);
}

// ---- all ----

ld_status ld_plot(const ld_picture *picture, const char *file, ld_error *error)
{
    assert(picture && file);
    plot_format format = PLOT_SVG;
    bool scene = is_scene(file);
    ld_status status = check_picture(picture, error);
    if (!status)
        status = scene ? check_scene(picture, error) : plot_format_of(file, &format, error);
    if (!status && !scene && picture->scene)
        status = ld_fail(error, LD_ERR_INPUT, "magnify and slower are for a scene (.glb)");
    history_data run[PLOT_RUNS];
    size_t read = 0;
    if (picture->note)
        *picture->note = '\0';
    while (!status && read < picture->folder_count) {
        status = read_folder(picture->folder[read], picture->note, &run[read], error);
        read += !status;
    }
    if (!status)
        status = scene ? write_scene(picture, run, file, error)
                       : draw_runs(picture, run, format, file, error);
    while (read > 0)
        history_free(&run[--read]);
    return status;
}
