// Cost of a row in history.h5 and history.csv, and of opening and closing the files: 60 and 110
// columns, process CPU time.
#include <math.h>
#include <unistd.h>

#include "bench_sample.h"
#include "results/history.h"

enum { MOST_COLUMNS = 110, ROWS = 50000 };

static char names[MOST_COLUMNS][16];
static ld_column columns[MOST_COLUMNS];

static void check(ld_status status, const ld_error *error)
{
    if (status) {
        fprintf(stderr, "%s\n", error->text);
        exit(1);
    }
}

static void print_file(const char *file, size_t count, double row, double ends)
{
    char what[64];
    snprintf(what, sizeof what, "%s, %zu columns: a row", file, count);
    print(what, &row, 1, 1e-6, "us");
    snprintf(what, sizeof what, "%s, %zu columns: to open and close", file, count);
    print(what, &ends, 1, 1e-3, "ms");
}

static void bench_hdf5(const char *path, size_t count, const double *values)
{
    ld_error error;
    history_hdf5 *history = NULL;
    double start = now();
    check(history_hdf5_create(path, "bench", &history, &error), &error);
    check(history_hdf5_begin(history, columns, count, &error), &error);
    double opened = now();
    for (size_t row = 0; row < ROWS; row++)
        check(history_hdf5_row(history, values + row % 64, &error), &error);
    double written = now();
    check(history_hdf5_close(history, NULL, &error), &error);
    print_file("history.h5", count, (written - opened) / ROWS, opened - start + now() - written);
}

static void bench_csv(const char *path, size_t count, const double *values)
{
    ld_error error;
    history_csv *history = NULL;
    double start = now();
    check(history_csv_create(path, &history, &error), &error);
    check(history_csv_begin(history, columns, count, &error), &error);
    double opened = now();
    for (size_t row = 0; row < ROWS / 10; row++)
        check(history_csv_row(history, values + row % 64, count, &error), &error);
    double written = now();
    check(history_csv_close(history, &error), &error);
    print_file("history.csv", count, 10 * (written - opened) / ROWS,
               opened - start + now() - written);
}

int main(void)
{
    double values[MOST_COLUMNS + 64];
    for (int i = 0; i < MOST_COLUMNS + 64; i++)
        values[i] = sin(i) * pow(10, i % 7 - 3);
    for (int i = 0; i < MOST_COLUMNS; i++) {
        snprintf(names[i], sizeof names[i], "column%d", i);
        columns[i] = (ld_column){names[i], "m", "a column of the benchmark"};
    }
    char folder[] = "/tmp/launchdyn-bench-XXXXXX", path[64];
    if (!mkdtemp(folder))
        return 1;
    snprintf(path, sizeof path, "%s/history", folder);
    for (size_t count = 60; count <= MOST_COLUMNS; count += 50) {
        bench_hdf5(path, count, values);
        unlink(path);
        bench_csv(path, count, values);
        unlink(path);
    }
    return rmdir(folder) != 0;
}
