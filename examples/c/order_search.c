// The order of tubes that leaves the launcher calmest, on a reduced model of a salvo:
// superposition. A rocket leaves with the rates with which it would leave as the first one, plus
// what each earlier launch adds, by the tubes of both and the time between them. A study of salvos
// of two rockets gives both (scripts/order-study makes it): every ordered pair of tubes, at one to
// n - 1 times the interval, in any order of points, one sample or more at each.
//
//     order_search FOLDER INTERVAL [ORDER...]          e.g. order_search pairs 0.3 "2 1 3"
//
// Prints the scatter of the tip-off rates of the orders given, of the calmest and the roughest
// found by exchanges of two tubes from several starts, and, up to nine tubes, of all orders, which
// shows whether the search has found them. Scatter: root mean square, over rockets and samples, of
// how far pitch and yaw rate at the exit are from their means in the salvo of that sample.
#include <launchdyn/study_data.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 16, MOST_SAMPLES = 64, MOST_ENUMERATED = 9, STARTS = 20 };

typedef struct rates {
    double pitch, yaw; // at the exit [rad/s]
} rates;

typedef struct order_model {
    int tubes, samples;
    rates first[MOST][MOST_SAMPLES]; // of a rocket that leaves first
    // [i][j][m] what tube i, m intervals before, adds to j's
    rates after[MOST][MOST][MOST][MOST_SAMPLES];
    bool known[MOST][MOST][MOST];
} order_model;

typedef struct order {
    int tube[MOST]; // from 0
    double scatter; // [rad/s]
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

// Takes over the rates of the two rockets of a point, "[1, 2]" at "0.3 s", in each sample; NULL, or
// what is wrong with it.
static const char *take_point(order_model *self, const ld_study_point *point,
                              const ld_study_values *of, int pair, int interval, double unit)
{
    int i, j, samples = (int)(of->count / 2);
    double lag = strtod(point->text[interval], NULL) / unit;
    int m = lag < MOST ? (int)lround(lag) : MOST;
    if (sscanf(point->text[pair], "[%d , %d ]", &i, &j) != 2 || i < 1 || j < 1 || i > MOST ||
        j > MOST || m < 1 || m >= MOST || fabs(lag - m) > 1e-6)
        return "a point is no pair of tubes at a multiple of the interval";
    if (samples < 1 || samples > MOST_SAMPLES || of->count % 2 ||
        (self->samples && samples != self->samples))
        return "its points have not the same 1 to 64 samples of two rockets";
    for (size_t row = 0; row < of->count; row++) {
        if (of->rocket[row] != 1 + (int)(row % 2))
            return "a rocket of a pair is missing";
        rates *to = of->rocket[row] == 1 ? self->first[i - 1] : self->after[i - 1][j - 1][m];
        to[row / 2] = (rates){of->value[0][row], of->value[1][row]};
    }
    self->known[i - 1][j - 1][m] = true;
    self->tubes = i > self->tubes ? i : self->tubes;
    self->samples = samples;
    return NULL;
}

// What a launch adds is how the second rocket's rates differ from its own as the first one.
static const char *complete(order_model *self)
{
    for (int i = 0; i < self->tubes; i++)
        for (int j = 0; j < self->tubes; j++)
            for (int m = 1; m < self->tubes && i != j; m++) {
                if (!self->known[i][j][m])
                    return "it does not hold every pair of tubes at every multiple of the interval";
                for (int s = 0; s < self->samples; s++) {
                    self->after[i][j][m][s].pitch -= self->first[j][s].pitch;
                    self->after[i][j][m][s].yaw -= self->first[j][s].yaw;
                }
            }
    return NULL;
}

static const char *read_model(const char *folder, double unit, order_model *self)
{
    static ld_error error;
    static const char *const names[] = {"pitch_rate", "yaw_rate"};
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
        else
            why = take_point(self, point, of, pair, interval, unit);
    }
    ld_study_data_close(data);
    return why ? why : complete(self);
}

// Sum of squares of how far the rates of one sample's rockets are from their means.
static double square_within(const order_model *self, const int *tube, int sample)
{
    rates sum = {0, 0};
    double squares = 0;
    for (int k = 0; k < self->tubes; k++) {
        int j = tube[k];
        rates x = self->first[j][sample];
        for (int m = 1; m <= k; m++) {
            x.pitch += self->after[tube[k - m]][j][m][sample].pitch;
            x.yaw += self->after[tube[k - m]][j][m][sample].yaw;
        }
        sum.pitch += x.pitch;
        sum.yaw += x.yaw;
        squares += x.pitch * x.pitch + x.yaw * x.yaw;
    }
    return squares - (sum.pitch * sum.pitch + sum.yaw * sum.yaw) / self->tubes;
}

static double scatter_of(const order_model *self, const int *tube)
{
    double squares = 0;
    for (int sample = 0; sample < self->samples; sample++)
        squares += square_within(self, tube, sample);
    return sqrt(fmax(squares, 0) / (self->tubes * self->samples));
}

// ---- the search

static void swap(int *one, int *other)
{
    int kept = *one;
    *one = *other;
    *other = kept;
}

// Exchanges the two tubes that gain most, as long as any two gain; sign 1: the least scatter, -1:
// the greatest. Returns how many orders it has checked.
static long descend(const order_model *self, int sign, order *from)
{
    long looked = 0;
    for (bool better = true; better;) {
        int best[2] = {0, 0};
        double least = from->scatter;
        for (int i = 0; i < self->tubes; i++)
            for (int j = i + 1; j < self->tubes; j++) {
                swap(&from->tube[i], &from->tube[j]);
                double scatter = scatter_of(self, from->tube);
                swap(&from->tube[i], &from->tube[j]);
                looked++;
                if (sign * scatter < sign * least) {
                    least = scatter;
                    best[0] = i;
                    best[1] = j;
                }
            }
        better = best[0] != best[1];
        swap(&from->tube[best[0]], &from->tube[best[1]]);
        from->scatter = least;
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
    start.scatter = scatter_of(self, start.tube);
    return start;
}

static void print_order(const char *what, const order_model *self, const order *of)
{
    printf("%-12s %8.4f mrad/s  [", what, 1e3 * of->scatter);
    for (int k = 0; k < self->tubes; k++)
        printf("%s%d", k ? ", " : "", of->tube[k] + 1);
    puts("]");
}

// The calmest (sign 1) or roughest order that several starts lead to, and how often.
static order search(const order_model *self, int sign)
{
    const double tie = 1e-12; // [rad/s]
    order best = {.scatter = sign * INFINITY};
    int found = 0;
    long looked = 0;
    for (unsigned start = 0; start < STARTS; start++) {
        order end = start_order(self, start);
        looked += descend(self, sign, &end);
        if (sign * end.scatter < sign * best.scatter - tie) {
            best = end;
            found = 0;
        }
        found += fabs(end.scatter - best.scatter) < tie;
    }
    print_order(sign > 0 ? "calmest" : "roughest", self, &best);
    printf("             from %d of %d starts, %ld orders looked at\n", found, STARTS, looked);
    return best;
}

// ---- all orders

static int by_scatter(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Scatters of all orders of the tubes from place `k` on.
static size_t enumerate(const order_model *self, int *tube, int k, double *scatter, size_t count)
{
    if (k == self->tubes) {
        scatter[count] = scatter_of(self, tube);
        return count + 1;
    }
    for (int i = k; i < self->tubes; i++) {
        swap(&tube[k], &tube[i]);
        count = enumerate(self, tube, k + 1, scatter, count);
        swap(&tube[k], &tube[i]);
    }
    return count;
}

static void check_all_rules(const order_model *self)
{
    static const double share[] = {0, 0.25, 0.5, 0.75, 1};
    order all = start_order(self, 0);
    size_t count = 1;
    for (int k = 2; k <= self->tubes; k++)
        count *= (size_t)k;
    double *scatter = malloc(count * sizeof *scatter);
    if (!scatter)
        return;
    enumerate(self, all.tube, 0, scatter, 0);
    qsort(scatter, count, sizeof *scatter, by_scatter);
    printf("all %zu orders: least, quartiles, greatest", count);
    for (int i = 0; i < 5; i++)
        printf("%s %.4f", i ? "," : "", 1e3 * scatter[(size_t)(share[i] * (double)(count - 1))]);
    puts(" mrad/s");
    free(scatter);
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
    of->scatter = scatter_of(self, of->tube);
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
        check_all_rules(&model);
    return 0;
}
