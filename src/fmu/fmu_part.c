#include "fmu/fmu_part.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "model/parts.h"

enum { PATH_SIZE = 4096, PART_BYTES = 4096 };

static const char *const names[] = {"all", "vehicle", "launcher"};
enum { PARTS = sizeof names / sizeof *names };

const char *fmu_part_name(ld_fmu_part which)
{
    return names[which];
}

void fmu_part_take(ld_fmu_part which, ld_model *model)
{
    if (which == LD_FMU_LAUNCHER)
        model_make_base_external(model);
}

// An externally driven base rests at the origin, its tube along x, until it receives another.
static void stand_at_origin(fmu_part *part)
{
    memset(part->start, 0, sizeof part->start);
    part->start[3] = 1;
}

// A vehicle's start is where its launcher begins.
static ld_status stand_on_vehicle(const ld_simulation *whole, fmu_part *part, ld_error *error)
{
    double wrench[FMU_MOST_NUMBERS];
    for (int i = 0; i < FMU_MOST_NUMBERS; i++)
        wrench[i] = NAN;
    void *run = fmu_vehicle.begin(whole, wrench, error);
    if (!run)
        return error->status;
    ld_status status = fmu_vehicle.get_outputs(run, part->start, error);
    fmu_vehicle.end(run);
    return status;
}

const fmu_runner *fmu_part_runner(ld_fmu_part which, const ld_model *model)
{
    return which == LD_FMU_VEHICLE         ? &fmu_vehicle
           : model_base_is_external(model) ? &fmu_launch_external
                                           : &fmu_launch;
}

ld_status fmu_part_find(ld_fmu_part which, const ld_simulation *whole, fmu_part *part,
                        ld_error *error)
{
    part->which = which;
    if (which == LD_FMU_LAUNCHER)
        return stand_on_vehicle(whole, part, error);
    stand_at_origin(part);
    for (int i = 0; i < FMU_MOST_NUMBERS && which == LD_FMU_VEHICLE; i++)
        part->start[i] = NAN;
    return LD_OK;
}

// ---- in the resources ----

// The word and the numbers, a line each.
void fmu_part_write(const fmu_part *part, FILE *stream)
{
    fprintf(stream, "%s\n", names[part->which]);
    for (int i = 0; i < FMU_MOST_NUMBERS; i++)
        fprintf(stream, "%.17g\n", part->start[i]);
}

ld_status fmu_part_read(const char *resources, fmu_part *part, ld_error *error)
{
    char path[PATH_SIZE], *text;
    size_t length;
    ld_error why;
    snprintf(path, sizeof path, "%.4000s/" FMU_PART_FILE, resources);
    ld_status status = text_file_read(path, PART_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", path, why.text);
    char *next = strchr(text, '\n'), *end = next;
    int which = 0;
    for (; next && which < PARTS; which++)
        if (strlen(names[which]) == (size_t)(next - text) &&
            strncmp(names[which], text, (size_t)(next - text)) == 0)
            break;
    part->which = (ld_fmu_part)which;
    bool whole = next && which < PARTS;
    for (int i = 0; i < FMU_MOST_NUMBERS && whole; i++, next = end) {
        part->start[i] = strtod(next, &end);
        whole = end != next;
    }
    free(text);
    return whole ? LD_OK : ld_fail(error, LD_ERR_INPUT, "%.300s is damaged", path);
}
