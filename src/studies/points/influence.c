#include "studies/points/influence.h"

#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "math/functions.h"
#include "model/blocks/limits.h"
#include "studies/plan/draw.h"
#include "studies/statistics/sensitivity.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's sensitivities");
}

influence_kind influence_kind_of(const study_data *data)
{
    return data->plan.kind == LD_PLAN_SALTELLI ? INFLUENCE_INDICES
           : data->plan.kind == LD_PLAN_MORRIS ? INFLUENCE_EFFECTS
                                               : INFLUENCE_SHARES;
}

ld_status influence_check(const study_data *data, ld_index index, ld_error *error)
{
    static const char *const words[] = {"", "total", "first", "morris"};
    const influence_kind kind = influence_kind_of(data);
    const bool other = (index == LD_INDEX_MORRIS) != (kind == INFLUENCE_EFFECTS);
    if (index == LD_INDEX_USUAL ||
        (!other && (index != LD_INDEX_TOTAL || kind == INFLUENCE_INDICES)))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "--sensitivity %s requires samples of another plan: run launchdyn study FILE "
                   "--sensitivity %s into a folder of its own",
                   words[index], words[index]);
}

// ---- runs in their rows

// Values of a result [rows][runs of a row][rockets], NaN where there are none, of the rows that
// have any.
typedef struct run_grid {
    int64_t rows, rockets;
    int row;
    int64_t *number; // [rows] from 0, rises
    double *value;
} run_grid;

// A value's place among the rows; false where a database that was forged says something else.
static bool find_row(const study_data *data, const study_values *values, size_t i, int64_t *row,
                     int *run)
{
    if (values->sample[i] < 1 || values->rocket[i] < 1 || values->rocket[i] > LD_MAX_FIRINGS)
        return false;
    const int64_t number = (values->sample[i] - 1) / data->point_count;
    *row = number / data->plan.row;
    *run = (int)(number % data->plan.row);
    return true;
}

// Counts rows and rockets, and lists the rows.
static void count_rows(const study_data *data, const study_values *values, run_grid *grid)
{
    int64_t row;
    int run;
    for (size_t i = 0; i < values->count; i++) {
        if (!find_row(data, values, i, &row, &run))
            continue;
        if (grid->rows == 0 || grid->number[grid->rows - 1] != row)
            grid->number[grid->rows++] = row;
        if (values->rocket[i] > grid->rockets)
            grid->rockets = values->rocket[i];
    }
}

static ld_status make_grid(const study_data *data, const study_values *values, run_grid *grid,
                           ld_error *error)
{
    int64_t row, at = 0;
    int run;
    *grid =
        (run_grid){.row = data->plan.row, .number = malloc((values->count + 1) * sizeof(int64_t))};
    if (!grid->number)
        return no_memory(error);
    count_rows(data, values, grid);
    const size_t cells = (size_t)(grid->rows * grid->row * grid->rockets);
    grid->value = malloc((cells + 1) * sizeof(double));
    if (!grid->value)
        return no_memory(error);
    for (size_t i = 0; i < cells; i++)
        grid->value[i] = NAN;
    for (size_t i = 0; i < values->count; i++) {
        if (!find_row(data, values, i, &row, &run))
            continue;
        at += grid->number[at] != row;
        grid->value[(at * grid->row + run) * grid->rockets + values->rocket[i] - 1] =
            values->value[0][i];
    }
    return LD_OK;
}

static double run_value(const run_grid *grid, int64_t row, int run, int64_t rocket)
{
    return grid->value[(row * grid->row + run) * grid->rockets + rocket];
}

// Columns of the runs of one factor that are complete.
typedef struct run_columns {
    double *value[3];
    int64_t *group;
    int *rocket;
    size_t count;
} run_columns;

static bool allocate(run_columns *self, const run_grid *grid)
{
    const size_t most = (size_t)(grid->rows * grid->rockets) + 1;
    bool good = true;
    for (int k = 0; k < 3; k++)
        good &= (self->value[k] = malloc(most * sizeof(double))) != NULL;
    self->group = malloc(most * sizeof *self->group);
    self->rocket = malloc(most * sizeof *self->rocket);
    return good && self->group && self->rocket;
}

static void free_columns(run_columns *self)
{
    for (int k = 0; k < 3; k++)
        free(self->value[k]);
    free(self->group);
    free(self->rocket);
}

static void append(run_columns *self, const double value[3], int64_t group, int64_t rocket)
{
    for (int k = 0; k < 3; k++)
        if (isnan(value[k]))
            return;
    for (int k = 0; k < 3; k++)
        self->value[k][self->count] = value[k];
    self->group[self->count] = group;
    self->rocket[self->count] = (int)rocket + 1;
    self->count++;
}

// The three runs that tell of a factor; of a trajectory the effect.
static void gather(const study_data *data, const run_grid *grid, const influence *of, int number,
                   run_columns *columns)
{
    const study_plan *plan = &data->plan;
    const bool trajectory = plan->kind == LD_PLAN_MORRIS;
    columns->count = 0;
    for (int64_t row = 0; row < grid->rows; row++) {
        const int64_t sample = grid->number[row] + 1;
        int turn = trajectory ? draw_turn(plan->seed, plan->factors, sample, number) : 0;
        double step = trajectory ? draw_step(plan->seed, of->factor->name, sample) : 1;
        int64_t group = grid->number[row] * grid->row / data->strata;
        for (int64_t rocket = 0; rocket < grid->rockets; rocket++) {
            double runs[3] = {run_value(grid, row, 0, rocket), run_value(grid, row, 1, rocket),
                              run_value(grid, row, trajectory ? 1 : number + 2, rocket)};
            if (trajectory)
                runs[0] = runs[1] = runs[2] =
                    (run_value(grid, row, turn + 1, rocket) - run_value(grid, row, turn, rocket)) /
                    step;
            append(columns, runs, group, rocket);
        }
    }
}

static ld_status find_one(const study_data *data, const run_columns *columns, influence *of,
                          ld_error *error)
{
    const frozen_values frozen = {columns->value[0], columns->value[1], columns->value[2],
                                  columns->group,    columns->rocket,   columns->count};
    ld_status status =
        data->plan.kind == LD_PLAN_MORRIS
            ? elementary_effects_of(columns->value[0], columns->group, columns->count, &of->effects)
            : variance_indices_of(&frozen, &of->indices);
    return status ? no_memory(error) : LD_OK;
}

// Of samples in rows.
static ld_status find_by_rows(const study_data *data, const study_values *values, influence *list,
                              int count, ld_error *error)
{
    run_grid grid;
    run_columns columns = {0};
    ld_status status = make_grid(data, values, &grid, error);
    if (!status && !allocate(&columns, &grid))
        status = no_memory(error);
    for (int i = 0; i < count && !status; i++) {
        gather(data, &grid, &list[i], data->number[list[i].factor - data->column], &columns);
        status = find_one(data, &columns, &list[i], error);
    }
    free_columns(&columns);
    free(grid.number);
    free(grid.value);
    return status;
}

// ---- all of them

static const estimate unknown = {NAN, NAN, NAN};

// The factors of which something can be said.
static int list_factors(const study_data *data, influence *list)
{
    const bool rows = influence_kind_of(data) != INFLUENCE_SHARES;
    int count = 0;
    for (int i = data->result_count; i < data->column_count; i++)
        if (rows ? data->number[i] >= 0 : !data->column[i].seed)
            list[count++] = (influence){
                &data->column[i], {unknown, unknown, unknown, 0, 0}, {unknown, unknown, NAN, 0, 0}};
    return count;
}

// The result, then the factors whose values are asked for.
static ld_status read_values(const influence_question *question, const influence *list, int count,
                             study_values *values, ld_error *error)
{
    const study_column **column = calloc((size_t)count + 1, sizeof(void *));
    if (!column)
        return no_memory(error);
    column[0] = question->result;
    for (int i = 0; i < count; i++)
        column[i + 1] = list[i].factor;
    ld_status status =
        study_data_read(question->data, question->point, column, count + 1, values, error);
    free(column);
    return status;
}

double influence_rank(const influence *self, influence_kind kind, ld_index index)
{
    const bool first = kind == INFLUENCE_SHARES || index == LD_INDEX_FIRST;
    const double rank = kind == INFLUENCE_EFFECTS ? self->effects.magnitude.value
                        : first                   ? self->indices.first.value
                                                  : self->indices.total.value;
    return isnan(rank) ? -INFINITY : rank;
}

static void sort(influence *list, int count, influence_kind kind, ld_index index)
{
    for (int i = 1; i < count; i++) {
        influence one = list[i];
        int at = i;
        for (; at > 0 &&
               influence_rank(&list[at - 1], kind, index) < influence_rank(&one, kind, index);
             at--)
            list[at] = list[at - 1];
        list[at] = one;
    }
}

ld_status influences_of(const influence_question *question, study_values *values, influence *list,
                        int *count, ld_error *error)
{
    const study_data *data = question->data;
    const influence_kind kind = influence_kind_of(data);
    const bool shares = kind == INFLUENCE_SHARES;
    *count = list_factors(data, list);
    ld_status status = read_values(question, list, shares ? *count : 0, values, error);
    if (!status && !shares)
        status = find_by_rows(data, values, list, *count, error);
    for (int i = 0; i < *count && !status && shares && values->count > 0; i++)
        list[i].indices.first =
            sensitivity_of(values->value[i + 1], values->value[0], values->sample, values->group,
                           values->count, list[i].factor->per_rocket);
    sort(list, *count, kind, question->index);
    return status;
}

// ---- in words

// "66 % [64, 68]"
static void write_percent(char text[64], const estimate *e)
{
    snprintf(text, 64, "%.3g %% [%.3g, %.3g]", 100 * e->value, 100 * e->low, 100 * e->high);
}

static void append_text(char text[INFLUENCE_TEXT], const char *more)
{
    size_t length = strlen(text);
    snprintf(text + length, INFLUENCE_TEXT - length, "%s", more);
}

// Those whose share with others is above zero by 1.5 times half its interval: of many factors some
// are by once that by chance. At most three are named.
void influence_together(const influence *list, int count, char text[INFLUENCE_TEXT])
{
    enum { NAMED = 3 };
    int found = 0;
    char one[256], share[64];
    text[0] = '\0';
    for (int i = 0; i < count; i++) {
        const estimate *e = &list[i].indices.together;
        if (!(e->value > 1.5 * (e->value - e->low)) || !(100 * e->value >= 0.5))
            continue;
        write_percent(share, e);
        snprintf(one, sizeof one, "%s %.120s %s", found ? "," : "with other factors act",
                 list[i].factor->name, share);
        if (found++ < NAMED)
            append_text(text, one);
    }
    if (found > NAMED) {
        snprintf(one, sizeof one, ", and %d more", found - NAMED);
        append_text(text, one);
    }
    append_text(text, found ? "" : "no significant interaction of factors");
}

static void tell_effects(const influence *first, char text[INFLUENCE_TEXT])
{
    const double ratio = first->effects.deviation / first->effects.magnitude.value;
    append_text(text, ratio < 0.1 ? "; its effect is nearly the same everywhere (sigma below 10 % "
                                    "of mu*)."
                      : ratio < 0.5
                          ? "; its effect varies, by curvature or other factors (sigma "
                            "below half of mu*)."
                          : "; its effect depends strongly on where it starts or on other "
                            "factors (sigma above half of mu*).");
}

void influence_sentence(const study_column *result, influence_kind kind, const influence *list,
                        int count, char text[INFLUENCE_TEXT])
{
    char share[64], together[INFLUENCE_TEXT];
    text[0] = '\0';
    if (count == 0 || kind == INFLUENCE_SHARES)
        return;
    const influence *first = list;
    for (int i = 1; i < count; i++)
        if (influence_rank(&list[i], kind, LD_INDEX_USUAL) >
            influence_rank(first, kind, LD_INDEX_USUAL))
            first = &list[i];
    if (!isfinite(influence_rank(first, kind, LD_INDEX_USUAL)))
        return;
    if (kind == INFLUENCE_EFFECTS) {
        snprintf(text, INFLUENCE_TEXT, "%.120s moves %.120s most", first->factor->name,
                 result->name);
        tell_effects(first, text);
        return;
    }
    write_percent(share, &first->indices.total);
    snprintf(text, INFLUENCE_TEXT, "%.120s makes %s of the variance of %.120s", first->factor->name,
             share, result->name);
    write_percent(share, &first->indices.first);
    append_text(text, ", alone ");
    append_text(text, share);
    append_text(text, "; ");
    influence_together(list, count, together);
    append_text(text, together);
    append_text(text, ".");
}
