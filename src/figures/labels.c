// Where names stand so that none goes through another.
#include "figures/labels.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { FAR = 12 }; // gaps that a name may stand from its place

// Takes away names of the greatest rank, the later first, until the others have room; `order` takes
// those left as they stand along the line. Returns how many those are.
static size_t keep_names(const label_on_line *name, size_t count, double room, double gap,
                         size_t order[LABELS_MOST])
{
    double taken = -gap;
    for (size_t i = 0; i < count; i++) {
        order[i] = i;
        taken += name[i].width + gap;
    }
    while (count > 0 && taken > room) {
        size_t last = 0;
        for (size_t k = 1; k < count; k++)
            if (name[order[k]].rank >= name[order[last]].rank)
                last = k;
        taken -= name[order[last]].width + gap;
        count--;
        memmove(order + last, order + last + 1, (count - last) * sizeof *order);
    }
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k > 0 && name[order[k]].at < name[order[k - 1]].at; k--) {
            size_t other = order[k];
            order[k] = order[k - 1];
            order[k - 1] = other;
        }
    return count;
}

// Places the names of `order`, which have room, from the left and back from the right.
static void place_names(label_on_line *name, const size_t *order, size_t count, double low,
                        double high, double gap)
{
    double free = low, end = high;
    for (size_t k = 0; k < count; k++) {
        label_on_line *one = &name[order[k]];
        one->left = fmax(one->at - one->width / 2, free);
        free = one->left + one->width + gap;
    }
    for (size_t k = count; k-- > 0;) {
        label_on_line *one = &name[order[k]];
        one->left = fmin(one->left, end - one->width);
        end = one->left - gap;
    }
}

static double offset_of(const label_on_line *one)
{
    return fabs(one->left + one->width / 2 - one->at);
}

// Where a name stands so far from its place, takes away, of those that have moved half as far, the
// one of the greatest rank, of equal ones the later. Returns how many are left.
static size_t drop_far_name(label_on_line *name, size_t *order, size_t count, double far)
{
    size_t worst = count;
    double most = 0;
    for (size_t k = 0; k < count; k++) {
        const label_on_line *one = &name[order[k]];
        most = fmax(most, offset_of(one));
        if (offset_of(one) > far / 2 && (worst == count || one->rank >= name[order[worst]].rank))
            worst = k;
    }
    if (most <= far || worst == count)
        return count;
    name[order[worst]].left = NAN;
    memmove(order + worst, order + worst + 1, (count - worst - 1) * sizeof *order);
    return count - 1;
}

void labels_place_on_line(label_on_line *name, size_t count, double low, double high, double gap)
{
    assert(count <= LABELS_MOST);
    size_t order[LABELS_MOST];
    size_t kept = keep_names(name, count, high - low, gap, order), before;
    for (size_t i = 0; i < count; i++)
        name[i].left = NAN;
    do {
        before = kept;
        place_names(name, order, kept, low, high, gap);
        kept = drop_far_name(name, order, kept, FAR * gap);
    } while (kept < before);
}

// ---- beside points ----

static bool do_overlap(const label_box *a, const label_box *b)
{
    return a->left < b->right && b->left < a->right && a->top < b->bottom && b->top < a->bottom;
}

static bool is_free(const label_box *box, const label_box *bounds, const label_box *taken,
                    size_t count)
{
    bool free = box->left >= bounds->left && box->right <= bounds->right &&
                box->top >= bounds->top && box->bottom <= bounds->bottom;
    for (size_t i = 0; i < count; i++)
        free = free && !do_overlap(box, &taken[i]);
    return free;
}

static size_t covered(const label_box *box, const double (*others)[2], size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += others[i][0] > box->left && others[i][0] < box->right && others[i][1] > box->top &&
               others[i][1] < box->bottom;
    return sum;
}

void labels_place_beside(label_beside *name, size_t count, double height, const label_box *bounds,
                         const double (*others)[2], size_t other_count)
{
    assert(count <= LABELS_MOST);
    enum { SIDES = 6 };
    const double around = 5, dot = 4;
    label_box taken[2 * LABELS_MOST];
    for (size_t i = 0; i < count; i++)
        taken[i] = (label_box){name[i].x - dot, name[i].x + dot, name[i].y - dot, name[i].y + dot};
    size_t used = count;
    for (size_t i = 0; i < count; i++) {
        label_beside *one = &name[i];
        const double w = one->width,
                     side[SIDES][2] = {{around, -height},          {around, 0},
                                       {-around - w, -height},     {-around - w, 0},
                                       {-w / 2, -height - around}, {-w / 2, around}};
        size_t fewest = 0;
        one->placed = false;
        for (int k = 0; k < SIDES; k++) {
            label_box box = {one->x + side[k][0], one->x + side[k][0] + w, one->y + side[k][1],
                             one->y + side[k][1] + height};
            size_t hidden = covered(&box, others, other_count);
            if (!is_free(&box, bounds, taken, used) || (one->placed && hidden >= fewest))
                continue;
            one->placed = true;
            one->box = box;
            fewest = hidden;
        }
        if (one->placed)
            taken[used++] = one->box;
    }
}

// ---- letters ----

double label_width(const char *text, double size)
{
    double width = 0; // of DejaVu Sans, which is wide
    for (; *text; text++)
        width += strchr("fijlrt -", *text) ? 0.42 : strchr("mw", *text) ? 0.98 : 0.64;
    return width * size;
}
