// Derivatives as a table a key, or as JSON.
#include <math.h>
#include <string.h>

#include "base/printed.h"
#include "derivatives/derivatives.h"
#include "launchdyn/version.h"
#include "math/functions.h"
#include "results/json.h"
#include "studies/show/show_numbers.h"

static const char usual[] = "t_release,t_front,t_middle,t_rear,exit_speed,spin_rate,"
                            "tip_off.pitch_rate,tip_off.yaw_rate,pitch_rate,yaw_rate,apogee,"
                            "downrange,drift,time_of_flight,impact_speed";
// Of the derivative: sides that are farther apart are not those of a smooth launch.
static const double APART = 0.01;

enum { MOST_RESULTS = 256 };
typedef struct result_list {
    int count;
    quantity_walk result[MOST_RESULTS];
} result_list;

static bool is_known(const ld_derivatives *self, const quantity_walk *result)
{
    return !isnan(quantity_value(result, &self->summary[0].rocket[0]));
}

// The results of these names; of the usual ones those that the launch has.
static ld_status choose_results(const ld_derivatives *self, const char *names, result_list *list,
                                ld_error *error)
{
    const char *at = names ? names : usual;
    list->count = 0;
    while (*at && list->count < MOST_RESULTS) {
        char name[QUANTITY_NAME], near[QUANTITY_NAME];
        int length = (int)strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", length, at);
        at += length + (at[length] == ',');
        quantity_walk found = study_result_find(&self->things, name);
        if (found.row && (names || is_known(self, &found))) {
            list->result[list->count++] = found;
        } else if (names) {
            study_result_near(&self->things, name, near);
            return ld_fail(error, LD_ERR_INPUT, "there is no result \"%s\"%s%s%s", VISIBLE(name),
                           near[0] ? "; did you mean \"" : "", near, near[0] ? "\"?" : "");
        }
    }
    return LD_OK;
}

static bool is_smooth(const ld_derivative *of)
{
    return of->same_events && !(fabs(of->right - of->left) > APART * fabs(of->derivative));
}

// The unit in which people read a key, and the factor from it to SI.
static study_unit unit_of(const derivative_key *key)
{
    const char *unit = key->place.row->unit ? key->place.row->unit : "";
    const double degree = 1.7453292519943295e-2;
    return strcmp(unit, "rad") == 0 ? (study_unit){"deg", degree} : (study_unit){unit, 1};
}

static void print_row(const quantity_walk *result, const derivative_key *key,
                      const ld_derivative *of, int width, FILE *stream)
{
    char name[QUANTITY_NAME];
    study_result_name(result, name);
    study_unit unit = study_result_unit(name, result->row->unit);
    double each = unit.factor * of->derivative;
    show_name(stream, width, name, unit.name);
    show_number(stream, 12, of->value * unit.factor, 6);
    show_number(stream, 14, each * unit_of(key).factor, 6);
    show_number(stream, 14, key->value != 0 ? each * 0.01 * fabs(key->value) : NAN, 4);
    fputs(is_smooth(of) || isnan(of->derivative) ? "\n" : " *\n", stream);
}

static void print_key(const ld_derivatives *self, int key, const result_list *list, int width,
                      FILE *stream)
{
    const derivative_key *of = &self->key[key];
    study_unit unit = unit_of(of);
    char each[64];
    snprintf(each, sizeof each, "per %s", unit.name[0] ? unit.name : "1");
    fprintf(stream, "%s: %.6g%s%s, changed by %.3g%s%s to either side\n", of->place.path,
            of->value / unit.factor, unit.name[0] ? " " : "", unit.name, of->step / unit.factor,
            unit.name[0] ? " " : "", unit.name);
    fprintf(stream, "%-*s%13s%15s%15s\n", width, "result", "value", each, "per 1 %");
    for (int i = 0; i < list->count; i++) {
        ld_derivative value = derivative_of(self, &list->result[i], key);
        print_row(&list->result[i], of, &value, width, stream);
    }
}

// How many derivatives are marked.
static int count_rough(const ld_derivatives *self, const result_list *list)
{
    int rough = 0;
    for (int key = 0; key < self->keys; key++)
        for (int i = 0; i < list->count; i++) {
            ld_derivative value = derivative_of(self, &list->result[i], key);
            rough += !is_smooth(&value) && !isnan(value.derivative);
        }
    return rough;
}

ld_status ld_derivatives_print(const ld_derivatives *self, const char *results, FILE *stream,
                               ld_error *error)
{
    enum { WIDTH = 30 };
    result_list list;
    ld_status status = choose_results(self, results, &list, error);
    for (int key = 0; key < self->keys && !status; key++) {
        print_key(self, key, &list, WIDTH, stream);
        fputs(key + 1 < self->keys ? "\n" : "", stream);
    }
    if (!status && count_rough(self, &list) > 0)
        fputs("* left and right differ by more than 1 %, or in their events: the launch is not "
              "smooth there (a strike begins or ends), or the step too wide\n",
              stream);
    return status;
}

static void write_result(json_writer *json, const quantity_walk *result, const ld_derivative *of)
{
    char name[QUANTITY_NAME];
    study_result_name(result, name);
    json_open(json, NULL, '{');
    json_text(json, "name", name);
    json_text(json, "unit", result->row->unit);
    json_number(json, "value", of->value);
    json_number(json, "derivative", of->derivative);
    json_number(json, "left", of->left);
    json_number(json, "right", of->right);
    json_truth(json, "same_events", of->same_events);
    json_truth(json, "smooth", is_smooth(of));
    json_close(json, '}');
}

static void write_key(json_writer *json, const ld_derivatives *self, int key,
                      const result_list *list)
{
    const derivative_key *of = &self->key[key];
    json_open(json, NULL, '{');
    json_text(json, "path", of->place.path);
    json_text(json, "unit", of->place.row->unit ? of->place.row->unit : "");
    json_number(json, "value", of->value);
    json_number(json, "step", of->step);
    json_open(json, "results", '[');
    for (int i = 0; i < list->count; i++) {
        ld_derivative value = derivative_of(self, &list->result[i], key);
        write_result(json, &list->result[i], &value);
    }
    json_close(json, ']');
    json_close(json, '}');
}

ld_status ld_derivatives_print_json(const ld_derivatives *self, const char *results, FILE *stream,
                                    ld_error *error)
{
    enum { FORMAT = 1 };
    json_writer json = {.file = stream};
    result_list list;
    ld_status status = choose_results(self, results, &list, error);
    if (status)
        return status;
    json_open(&json, NULL, '{');
    json_integer(&json, "format", FORMAT);
    json_text(&json, "version", LD_VERSION);
    json_open(&json, "keys", '[');
    for (int key = 0; key < self->keys; key++)
        write_key(&json, self, key, &list);
    json_close(&json, ']');
    json_close(&json, '}');
    fputs("\n", stream);
    return LD_OK;
}
