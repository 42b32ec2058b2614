#include "systems/launching/launching.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "elements/tail.h"
#include "elements/tube/shortening.h"
#include "elements/tube/tube_dynamics.h"
#include "math/lanes.h"
#include "model/fields/field.h"
#include "model/parts.h"
#include "model/salvo.h"

// ---- set-up ----

static void lay_out(launching_layout *at, int nq)
{
    int n = 0;
    at->nq = nq;
    at->r = n, n += 3;
    at->quaternion = n, n += 4;
    at->v = n, n += 3;
    at->w = n, n += 3;
    at->q = n, n += nq;
    at->q_dot = n, n += nq;
    at->x = n, n += X_COUNT;
    at->V = n, n += 6;
    at->count = n;
}

void launching_set_rocket(launching_system *self, const ld_rocket *rocket)
{
    self->rocket = rocket;
    const ld_tubes *tubes = model_tubes(self->model);
    adaptors_build(tubes, rocket, &self->adaptors);
    surfaces_build(&tubes->guide, rocket, &self->surfaces);
    drag_build(rocket, &self->surfaces, &self->drag);
    slot_build(&tubes->slot, rocket, &self->slot);
    lock_build(&rocket->lock, self->slot.present || self->surfaces.flat, &self->lock);
    crossflow_build(&rocket->aerodynamics, &self->crossflow);
    self->pressure.start = rocket->start_at;
}

// Works up to the last kind that the model has.
static int works_of(const ld_model *model)
{
    if (model_has_guide_jet(model))
        return POWER_GUIDE_JET + 1;
    if (model_has_guide_wind(model))
        return POWER_GUIDE_WIND + 1;
    if (model_rocket(model)->line.present)
        return POWER_LINE + 1;
    return model_slide_count(model)    ? POWER_RECOIL + 1
           : model_has_pressure(model) ? POWER_PRESSURE + 1
           : model_feels_air(model)    ? POWER_AIR + 1
                                       : POWER_ALWAYS;
}

// Modes and coefficients follow from all keys of `tubes` but those of slot, guide, pressure,
// wind and jet, of where the tubes are and of what is asked for.
static bool same_tube(const ld_tubes *a, const ld_tubes *b)
{
    for (const field_row *key = tubes_block.fields; key->name; key++) {
        bool planes_differ = key->offset == offsetof(ld_tubes, layout) ||
                             key->offset == offsetof(ld_tubes, empty) ||
                             key->offset == offsetof(ld_tubes, slot) ||
                             key->offset == offsetof(ld_tubes, pressure) ||
                             key->offset == offsetof(ld_tubes, guide) ||
                             key->offset == offsetof(ld_tubes, initial_shape) ||
                             key->offset == offsetof(ld_tubes, wind_drag) ||
                             key->offset == offsetof(ld_tubes, jet) ||
                             key->offset == offsetof(ld_tubes, jet_scale) ||
                             key->offset == offsetof(ld_tubes, jet_face) ||
                             key->offset == offsetof(ld_tubes, deflector) ||
                             key->offset == offsetof(ld_tubes, station);
        if (!planes_differ && !field_same(key, a, b))
            return false;
    }
    return true;
}

launching_tube launching_take_tube(launching_system *self)
{
    launching_tube tube = {self->tubes, self->tube.flexible, self->tube.packed};
    self->tube.flexible = (flexible_tube){0};
    self->tube.packed = NULL;
    return tube;
}

void launching_tube_free(launching_tube *self)
{
    shortening_free(self->tube.shortening);
    flexible_tube_free(&self->tube);
    free(self->packed);
    self->packed = NULL;
}

static void use_tube(launching_system *self, launching_tube *kept)
{
    self->tube.flexible = kept->tube;
    self->tube.packed = kept->packed;
    *kept = (launching_tube){0};
}

// What a system finds besides of a tube: the shortening, the shapes by element.
static ld_status complete_tube(flexible_tube *tube, const ld_tubes *tubes, packed_element **packed,
                               ld_error *error)
{
    ld_status status = LD_OK;
    if (tubes->modes.geometric_stiffness == LD_GEOMETRIC_YES)
        status = shortening_build(tube, tubes, error);
    if (status)
        return status;
    size_t count = (size_t)tube->element_count;
    *packed = aligned_alloc(64, (count * sizeof **packed + 63) / 64 * 64);
    if (!*packed)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the tube's shapes");
    for (size_t i = 0; i < count; i++)
        tube_pack_element(tube, &tube->element[i], &(*packed)[i]);
    return LD_OK;
}

static ld_status build_tube(launching_system *self, ld_error *error)
{
    tube_system *tube = &self->tube;
    ld_error reason = {0};
    ld_status status = flexible_tube_build(&tube->flexible, &self->tubes, &reason);
    if (!status)
        status = complete_tube(&tube->flexible, &self->tubes, &tube->packed, &reason);
    if (!status)
        return LD_OK;
    launching_free(self);
    return ld_fail(error, status == LD_ERR_MEMORY ? status : LD_ERR_INPUT, "%s%s",
                   status == LD_ERR_MEMORY    ? ""
                   : status == LD_ERR_NUMERIC ? "tubes.sections: "
                                              : "tubes.modes: ",
                   reason.text);
}

ld_status launching_take_unslowed(launching_system *self, launching_tube *to, ld_error *error)
{
    flexible_tube *unslowed = self->tube.flexible.unslowed;
    *to = (launching_tube){.tubes = self->tubes};
    if (!unslowed)
        return LD_OK;
    to->tubes.modes.cut = 0;
    to->tube = *unslowed;
    free(unslowed);
    self->tube.flexible.unslowed = NULL;
    return complete_tube(&to->tube, &to->tubes, &to->packed, error);
}

static ld_status build_cuts(launching_system *self, ld_error *error)
{
    int count = self->tubes.station_count;
    if (count == 0)
        return LD_OK;
    self->cut = malloc((size_t)count * sizeof *self->cut);
    if (!self->cut) {
        launching_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the loads at %d stations", count);
    }
    for (int i = 0; i < count; i++)
        guide_cut_build(&self->cut[i], &self->tube.flexible, &self->tubes, &self->tubes.station[i]);
    return LD_OK;
}

ld_status launching_build(launching_system *self, const ld_model *model, launching_tube *kept,
                          ld_error *error)
{
    memset(self, 0, sizeof *self);
    const ld_tubes *tubes = model_tubes(model);
    self->model = model;
    self->tubes = *tubes;
    self->tube.gravity = model_gravity(model);
    ld_status status = LD_OK;
    if (kept && kept->packed && same_tube(&kept->tubes, &self->tubes))
        use_tube(self, kept);
    else
        status = build_tube(self, error);
    if (status)
        return status;
    lay_out(&self->layout, tube_mode_count(&self->tube.flexible));
    tube_build_rows(tubes->support_count, &self->tube);
    supports_build(tubes, &self->tube, &self->supports);
    tail_fold(&tubes->tail, &self->tube);
    self->work_count = works_of(model);
    status = pressure_build(tubes, &self->pressure, error);
    if (!status)
        status = initial_shape_build(tubes, &self->tube.initial, error);
    if (!status)
        status = guide_wind_build(tubes, &self->wind, error);
    if (!status)
        status = build_cuts(self, error);
    if (status) {
        launching_free(self);
        return status;
    }
    launching_set_rocket(self, salvo_rocket(model, 0));
    self->wide_instructions = lanes_have_avx2();
    return LD_OK;
}

void launching_free(launching_system *self)
{
    shortening_free(self->tube.flexible.shortening);
    flexible_tube_free(&self->tube.flexible);
    free(self->tube.packed);
    self->tube.packed = NULL;
    pressure_free(&self->pressure);
    initial_shape_free(self->tube.initial);
    self->tube.initial = NULL;
    guide_wind_free(&self->wind);
    free(self->cut);
    self->cut = NULL;
}

bool launching_is_general(const launching_system *self)
{
    const flexible_tube *tube = &self->tube.flexible;
    return tube->na > 0 || tube->shortening || tube->shear;
}

bool launching_holds_places(const launching_system *self)
{
    return self->adaptors.law.held || self->supports.clamps;
}

// ---- rates ----

void launching_rates(const launching_system *self, const double *state, const launching_output *out,
                     bool rocket, double *state_dot)
{
    const launching_layout *at = &self->layout;
    quat q = q_from(state + at->quaternion);
    v3 v = v3_from(state + at->v), w = v3_from(state + at->w);
    v3_store(state_dot + at->r, m3_apply(q_matrix(q), v));
    quat q_dot = q_rate(q, w);
    memcpy(state_dot + at->quaternion, &q_dot, sizeof q_dot);
    v3_store(state_dot + at->v, v3_sub(out->a, v3_cross(w, v)));
    v3_store(state_dot + at->w, out->w_dot);
    memcpy(state_dot + at->q, state + at->q_dot, (size_t)at->nq * sizeof(double));
    memcpy(state_dot + at->q_dot, out->q_ddot, (size_t)at->nq * sizeof(double));
    if (rocket) {
        // V in R: d/dt V = [a_O1; alpha_B] - w x V
        memcpy(state_dot + at->x, out->x_dot, X_COUNT * sizeof(double));
        v3 v_O1 = v3_from(state + at->V), w_B = v3_from(state + at->V + 3);
        v3_store(state_dot + at->V, v3_sub(out->a_O1, v3_cross(w, v_O1)));
        v3_store(state_dot + at->V + 3, v3_sub(out->alpha_B, v3_cross(w, w_B)));
    } else {
        memset(state_dot + at->x, 0, (X_COUNT + 6) * sizeof(double));
    }
}
