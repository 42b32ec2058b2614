// Footprints: of clouds whose distribution is known the true content of a region lies in its
// interval as often as is said, and the contour that has the share exactly in that of the area.
// ctest: slow
#include "support/check.h"

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/points/footprint.h"

enum { MOST = 12000, LINES = 1200 };

static double x[MOST], y[MOST];
static int64_t group[MOST];

static double normal(uint64_t stream, uint64_t i, uint64_t j)
{
    return normal_quantile(random_uniform(31, stream, i, j, 0));
}

// ---- clouds of which all is known

// Of a share of the landings: x is normal, and y, about a parabola of x.
typedef struct part {
    double share, mean, deviation;   // of x
    double level, slope, bow, width; // y: level + slope x + bow x^2, and its deviation
} part;

typedef struct known {
    const char *name;
    part part[2]; // share 0: there is none
} known;

static const known clouds[] = {
    {"oblong, askew", {{1, 900, 60, -200, 0.3, 0, 14}}},
    {"bent", {{1, 0, 100, 800, 0, 4e-3, 20}}},
    {"two clumps", {{0.7, 0, 10, 0, 0, 0, 25}, {0.3, 160, 20, 90, 0.4, 0, 8}}},
    {"with a wide tenth", {{0.9, 0, 30, 0, 0, 0, 30}, {0.1, 0, 90, 0, 0, 0, 120}}},
};

// Rockets of a group share so much of their variance.
static void make_cloud(const known *of, uint64_t which, size_t count, size_t rockets, double shared)
{
    double own = sqrt(1 - shared), common = sqrt(shared);
    for (size_t i = 0; i < count; i++) {
        uint64_t g = i / rockets, k = which;
        const part *p = &of->part[random_uniform(32, 5, k, i, 0) > of->part[0].share];
        double u = p->mean + p->deviation * (own * normal(1, k, i) + common * normal(2, k, g));
        double v = own * normal(3, k, i) + common * normal(4, k, g);
        x[i] = u;
        y[i] = p->level + p->slope * u + p->bow * u * u + p->width * v;
        group[i] = (int64_t)g;
    }
}

// The share of a cloud within a contour, in closed form along lines of equal x.
typedef struct content {
    const footprint *of;
    const known *cloud;
    double from, step;
    double within[LINES];
} content;

static double below(const known *of, double at, double height)
{
    double sum = 0;
    for (int k = 0; k < 2; k++) {
        const part *p = &of->part[k];
        if (p->share == 0)
            continue;
        double z = (at - p->mean) / p->deviation;
        double middle = p->level + p->slope * at + p->bow * at * at;
        sum += p->share * exp(-0.5 * z * z) / (sqrt(2 * acos(-1)) * p->deviation) *
               normal_cumulative((height - middle) / p->width);
    }
    return sum;
}

static void add_line(void *self, double (*corner)[2], size_t count)
{
    content *c = self;
    double last[2], next[2];
    footprint_place(c->of, corner[count - 1], last);
    for (size_t i = 0; i < count; i++) {
        footprint_place(c->of, corner[i], next);
        double low = fmin(last[0], next[0]), high = fmax(last[0], next[0]);
        int first = (int)fmax(0, ceil((low - c->from) / c->step));
        for (int k = first; k < LINES && c->from + k * c->step < high; k++) {
            double at = c->from + k * c->step, share = (at - last[0]) / (next[0] - last[0]);
            double height = last[1] + share * (next[1] - last[1]);
            c->within[k] += (next[0] < last[0] ? 1 : -1) * below(c->cloud, at, height);
        }
        last[0] = next[0];
        last[1] = next[1];
    }
}

static double content_of(const footprint *of, const known *cloud, double level)
{
    static content c;
    double low = INFINITY, high = -INFINITY, sum = 0;
    for (int k = 0; k < 2 && cloud->part[k].share > 0; k++) {
        low = fmin(low, cloud->part[k].mean - 7 * cloud->part[k].deviation);
        high = fmax(high, cloud->part[k].mean + 7 * cloud->part[k].deviation);
    }
    c = (content){.of = of, .cloud = cloud, .from = low, .step = (high - low) / LINES};
    assert_int_equal(density_contour(&of->map, level, add_line, &c), LD_OK);
    for (int k = 0; k < LINES; k++)
        sum += c.within[k] * c.step;
    return sum;
}

static footprint found;

// How often, of so many regions.
typedef struct tally {
    int stated, held, straddled;
    double outside; // sum over regions, over what is said
} tally;

static void count_region(const known *cloud, int index, tally *sum)
{
    const footprint_region *region = &found.region[index];
    const estimate *level = &found.level[index];
    if (!region->stated)
        return;
    double share = content_of(&found, cloud, level->value);
    sum->stated++;
    sum->outside += (1 - share) / (1 - region->share);
    sum->held += region->content.low <= share && share <= region->content.high;
    sum->straddled +=
        content_of(&found, cloud, level->high) <= region->share &&
        (isnan(region->area.high) || content_of(&found, cloud, level->low) >= region->share);
}

static void check_tally(const char *name, const tally *sum, double least, double most)
{
    char text[128];
    snprintf(text, sizeof text, "%s: content in its interval [%%]", name);
    CHECK_WITHIN(text, 100.0 * sum->held / sum->stated, least, most);
    snprintf(text, sizeof text, "%s: area of the exact contour in its interval [%%]", name);
    CHECK_WITHIN(text, 100.0 * sum->straddled / sum->stated, least, most);
}

// The share for which there are just enough landings.
static void cover(const known *cloud, size_t count, size_t rockets, double shared, int repeats,
                  tally *all)
{
    tally of[FOOTPRINT_SHARES] = {0};
    for (int r = 0; r < repeats; r++) {
        make_cloud(cloud, (uint64_t)r, count, rockets, shared);
        assert_int_equal(footprint_of(x, y, group, count, &found), LD_OK);
        for (int k = 0; k < FOOTPRINT_SHARES; k++)
            count_region(cloud, k, &of[k]);
    }
    for (int k = 0; k < FOOTPRINT_SHARES; k++) {
        if (of[k].stated < repeats / 2)
            continue;
        char name[128];
        snprintf(name, sizeof name, "%s, %zu by %zu, %g %%", cloud->name, count / rockets, rockets,
                 100 * found.region[k].share);
        check_tally(name, &of[k], OF_ALL(90, 60), 100);
        all[k].stated += of[k].stated;
        all[k].held += of[k].held;
        all[k].straddled += of[k].straddled;
        all[k].outside += of[k].outside;
    }
}

static void test_coverage(void **state)
{
    (void)state;
    const int n = OF_ALL(120, 12);
    tally all[FOOTPRINT_SHARES] = {0};
    for (size_t k = 0; k < sizeof clouds / sizeof *clouds; k++) {
        cover(&clouds[k], 180, 1, 0, 4 * n, all);
        cover(&clouds[k], 900, 1, 0, 2 * n, all);
        cover(&clouds[k], 9000, 1, 0, n, all);
    }
    cover(&clouds[0], 3600, 6, 0.1, n, all);
    cover(&clouds[0], 3600, 18, 0.3, n, all);
    cover(&clouds[2], 3600, 6, 0.1, n, all);
    for (int k = 0; k < FOOTPRINT_SHARES; k++) {
        char name[64];
        snprintf(name, sizeof name, "all clouds, %g %%", 100 * found.region[k].share);
        check_tally(name, &all[k], OF_ALL(93, 85), OF_ALL(97, 100));
        CHECK_NEAR("all clouds: outside over what is said", all[k].outside / all[k].stated, 1,
                   0.05);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_coverage)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
