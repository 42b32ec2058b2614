// The order in which tubes fire so that impacts lie closest together, found on a reduced model of a
// salvo: by superposition. A rocket lands where it would land as the first one, plus what each
// earlier shot adds, by the tubes of both and the time between them. A study of salvos of two
// rockets without scatter gives both (scripts/order-study makes it): every ordered pair of tubes,
// at one to n - 1 times the interval, in any order of points.
//
//     order_search FOLDER INTERVAL [ORDER...]          e.g. order_search pairs 0.3 "1 2 3 4 5 6 7
//     8"
//
// Prints the spread (root mean square distance from the mean impact) of the orders given, of the
// best and the worst by exchanges of two tubes from several starts, and, up to nine tubes, of all
// orders, which shows whether the search has found them.
#include <launchdyn/study_data.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 16, MOST_ENUMERATED = 9, STARTS = 20 };

typedef struct impact {
    double downrange, drift; // [m]
} impact;

typedef struct order_model {
    int tubes;
    impact first[MOST];             // of a rocket that is fired first
    impact after[MOST][MOST][MOST]; // [i][j][m] what tube i, fired m intervals before, adds to j's
    bool known[MOST][MOST][MOST];
} order_model;

typedef struct order {
    int tube[MOST]; // from 0
    double spread;  // [m]
} order;

// ---- the reduced model

static int fail(const char *what, const char *why)
{
    fprintf(stderr, "order_search: %s: %s\n", what, why);
    return 1;
}

// Which columns of a point's texts are the order and the interval; false: not there.
static bool find_axes(const ld_study_data *data, int *pair, int *interval)
{
    *pair = *interval = -1;
    for (int axis = 0; ld_study_data_swept(data, axis); axis++) {
        if (strcmp(ld_study_data_swept(data, axis), "firing.order") == 0)
            *pair = axis;
        if (strcmp(ld_study_data_swept(data, axis), "firing.interval") == 0)
            *interval = axis;
    }
    return *pair >= 0 && *interval >= 0;
}

// Takes over the mean impacts of the two rockets of a point, "[1, 2]" at "0.3 s"; false: it is not
// such a pair.
static bool take_point(order_model *self, const ld_study_point *point, const ld_study_values *of,
                       int pair, int interval, double unit)
{
    int i, j;
    if (sscanf(point->text[pair], "[%d , %d ]", &i, &j) != 2 || of->count < 2)
        return false;
    double lag = strtod(point->text[interval], NULL) / unit, share = 2 / (double)of->count;
    int m = (int)lround(lag);
    if (i < 1 || j < 1 || i > MOST || j > MOST || m < 1 || m >= MOST || fabs(lag - m) > 1e-6)
        return false;
    impact mean[2] = {{0, 0}, {0, 0}};
    for (size_t row = 0; row < of->count; row++) {
        impact *to = &mean[of->rocket[row] == 2];
        to->downrange += share * of->value[0][row];
        to->drift += share * of->value[1][row];
    }
    self->first[i - 1] = mean[0];
    self->after[i - 1][j - 1][m] = mean[1];
    self->known[i - 1][j - 1][m] = true;
    self->tubes = i > self->tubes ? i : self->tubes;
    return true;
}

// What a shot adds is what the second rocket lands apart from itself as the first one.
static const char *complete(order_model *self)
{
    for (int i = 0; i < self->tubes; i++)
        for (int j = 0; j < self->tubes; j++)
            for (int m = 1; m < self->tubes && i != j; m++) {
                if (!self->known[i][j][m])
                    return "it does not hold every pair of tubes at every multiple of the interval";
                self->after[i][j][m].downrange -= self->first[j].downrange;
                self->after[i][j][m].drift -= self->first[j].drift;
            }
    return NULL;
}

static const char *read_model(const char *folder, double unit, order_model *self)
{
    static ld_error error;
    static const char *const names[] = {"downrange", "drift"};
    ld_study_data *data;
    int pair, interval;
    const ld_study_point *point;
    const char *why = NULL;
    if (ld_study_data_open(folder, &data, &error))
        return error.text;
    if (!find_axes(data, &pair, &interval))
        why = "it does not sweep firing.order and firing.interval";
    for (int number = 1; !why && (point = ld_study_data_point(data, number)); number++) {
        const ld_study_values *of;
        if (ld_study_data_values(data, number, names, 2, &of, &error))
            why = error.text;
        else if (!take_point(self, point, of, pair, interval, unit))
            why = "a point is no pair of tubes at a multiple of the interval";
    }
    ld_study_data_close(data);
    return why ? why : complete(self);
}

// Root mean square distance of the impacts from their mean.
static double spread_of(const order_model *self, const int *tube)
{
    double x[MOST], y[MOST], mean[2] = {0}, squares = 0, n = self->tubes;
    for (int k = 0; k < self->tubes; k++) {
        int j = tube[k];
        x[k] = self->first[j].downrange;
        y[k] = self->first[j].drift;
        for (int m = 1; m <= k; m++) {
            x[k] += self->after[tube[k - m]][j][m].downrange;
            y[k] += self->after[tube[k - m]][j][m].drift;
        }
        mean[0] += x[k] / n;
        mean[1] += y[k] / n;
    }
    for (int k = 0; k < self->tubes; k++)
        squares += (x[k] - mean[0]) * (x[k] - mean[0]) + (y[k] - mean[1]) * (y[k] - mean[1]);
    return sqrt(squares / n);
}

// ---- the search

static void swap(int *one, int *other)
{
    int kept = *one;
    *one = *other;
    *other = kept;
}

// Exchanges the two tubes that gain most, as long as any two gain; sign 1: the least spread, -1:
// the greatest. Returns how many spreads it has looked at.
static long descend(const order_model *self, int sign, order *from)
{
    long looked = 0;
    for (bool better = true; better;) {
        int best[2] = {0, 0};
        double least = from->spread;
        for (int i = 0; i < self->tubes; i++)
            for (int j = i + 1; j < self->tubes; j++) {
                swap(&from->tube[i], &from->tube[j]);
                double spread = spread_of(self, from->tube);
                swap(&from->tube[i], &from->tube[j]);
                looked++;
                if (sign * spread < sign * least) {
                    least = spread;
                    best[0] = i;
                    best[1] = j;
                }
            }
        better = best[0] != best[1];
        swap(&from->tube[best[0]], &from->tube[best[1]]);
        from->spread = least;
    }
    return looked;
}

// Another order for each number, always the same (a linear congruential generator).
static order start_order(const order_model *self, unsigned number)
{
    order start = {0};
    unsigned long long random = 1 + number;
    for (int k = 0; k < self->tubes; k++)
        start.tube[k] = k;
    for (int k = self->tubes - 1; k > 0; k--) {
        random = random * 6364136223846793005ULL + 1442695040888963407ULL;
        swap(&start.tube[k], &start.tube[(random >> 33) % (unsigned)(k + 1)]);
    }
    start.spread = spread_of(self, start.tube);
    return start;
}

static void print_order(const char *what, const order_model *self, const order *of)
{
    printf("%-12s %7.3f m  [", what, of->spread);
    for (int k = 0; k < self->tubes; k++)
        printf("%s%d", k ? ", " : "", of->tube[k] + 1);
    puts("]");
}

// The best of several starts; how often it was found.
static order search(const order_model *self, int sign)
{
    order best = {.spread = sign * INFINITY};
    int found = 0;
    long looked = 0;
    for (unsigned start = 0; start < STARTS; start++) {
        order end = start_order(self, start);
        looked += descend(self, sign, &end);
        if (sign * end.spread < sign * best.spread - 1e-9) {
            best = end;
            found = 0;
        }
        found += fabs(end.spread - best.spread) < 1e-9;
    }
    print_order(sign > 0 ? "best" : "worst", self, &best);
    printf("             from %d of %d starts, %ld orders looked at\n", found, STARTS, looked);
    return best;
}

// ---- all orders

static int by_spread(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Spreads of all orders of the tubes from place `k` on.
static size_t enumerate(const order_model *self, int *tube, int k, double *spread, size_t count)
{
    if (k == self->tubes) {
        spread[count] = spread_of(self, tube);
        return count + 1;
    }
    for (int i = k; i < self->tubes; i++) {
        swap(&tube[k], &tube[i]);
        count = enumerate(self, tube, k + 1, spread, count);
        swap(&tube[k], &tube[i]);
    }
    return count;
}

static void look_at_all(const order_model *self)
{
    static const double share[] = {0, 0.25, 0.5, 0.75, 1};
    order all = start_order(self, 0);
    size_t count = 1;
    for (int k = 2; k <= self->tubes; k++)
        count *= (size_t)k;
    double *spread = malloc(count * sizeof *spread);
    if (!spread)
        return;
    enumerate(self, all.tube, 0, spread, 0);
    qsort(spread, count, sizeof *spread, by_spread);
    printf("all %zu orders: least, quartiles, greatest", count);
    for (int i = 0; i < 5; i++)
        printf("%s %.3f", i ? "," : "", spread[(size_t)(share[i] * (double)(count - 1))]);
    puts(" m");
    free(spread);
}

// An order as the tubes' numbers with spaces or commas between; false: not each tube once.
static bool read_order(const order_model *self, const char *text, order *of)
{
    bool seen[MOST] = {false};
    char *end;
    for (int k = 0; k < self->tubes; k++, text = end) {
        text += strspn(text, " ,[");
        long tube = strtol(text, &end, 10);
        if (end == text || tube < 1 || tube > self->tubes || seen[tube - 1])
            return false;
        seen[tube - 1] = true;
        of->tube[k] = (int)tube - 1;
    }
    of->spread = spread_of(self, of->tube);
    return true;
}

int main(int argc, char **argv)
{
    static order_model model;
    double unit = argc > 2 ? strtod(argv[2], NULL) : 0;
    if (!(unit > 0))
        return fail("usage", "order_search FOLDER INTERVAL [ORDER...]");
    const char *why = read_model(argv[1], unit, &model);
    if (why)
        return fail(argv[1], why);
    for (int i = 3; i < argc; i++) {
        order given;
        if (!read_order(&model, argv[i], &given))
            return fail(argv[i], "not an order of all tubes");
        print_order("given", &model, &given);
    }
    search(&model, 1);
    search(&model, -1);
    if (model.tubes <= MOST_ENUMERATED)
        look_at_all(&model);
    return 0;
}
