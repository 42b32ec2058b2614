#include "model/fields/field_rows.h"
#include "model/fields/tables_mechanism.h"
#include "model/fields/tables_optimise.h"
#include "model/fields/tables_parts.h"

#define PI 3.14159265358979323846

// ---- environment

static const field_word earth_words[] = {{"flat", LD_EARTH_FLAT},
                                         {"round", LD_EARTH_ROUND},
                                         {"wgs84", LD_EARTH_WGS84},
                                         {"", LD_EARTH_GIVEN},
                                         {NULL, 0}};
static const field_word earth_models[] = {
    {"round", LD_EARTH_ROUND}, {"wgs84", LD_EARTH_WGS84}, {NULL, 0}};
static const field_row earth_fields[] = {
    {"model", CHOICE(ld_earth, model, earth_models), .required = true,
     .doc = "figure of the Earth; the keys below replace its numbers"},
    {"gm", NUMBER(ld_earth, gm, "m3/s2"), POSITIVE, NO_DEFAULT("3.986004418e14 m3/s2"),
     .doc = "gravitational constant times mass"},
    {"j2", NUMBER(ld_earth, j2, ""), FROM_TO(-0.1, 0.1),
     NO_DEFAULT("1.08262982e-3 (wgs84), 0 (round)"), .doc = "second zonal harmonic"},
    {"rotation", NUMBER(ld_earth, rotation, "rad/s"), FROM_TO(-1e-2, 1e-2),
     NO_DEFAULT("7.292115e-5 rad/s"), .doc = "about the polar axis"},
    {"radius", NUMBER(ld_earth, radius, "m"), FROM_TO(1e5, 1e9),
     NO_DEFAULT("6378137 m (wgs84), 6371007.1809 m (round)"),
     .doc = "of the equator or sphere; flattening of wgs84: 1/298.257223563"},
    {0}};
static const field_block earth_block = {.fields = earth_fields};

static const field_row site_fields[] = {
    {"latitude", NUMBER(ld_site, latitude, "rad"), FROM_TO(-PI / 2, PI / 2), DEFAULT(0),
     .doc = "geodetic latitude of I's origin"},
    {"longitude", NUMBER(ld_site, longitude, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .doc = "positive to the east"},
    {"altitude", NUMBER(ld_site, altitude, "m"), FROM_TO(-5000, 1e7), DEFAULT(0),
     .doc = "above the ellipsoid; flat Earth: altitude of y = 0"},
    {"azimuth", NUMBER(ld_site, azimuth, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(PI / 2),
     .doc = "of x of I, clockwise from north"},
    {0}};
static const field_block site_block = {.fields = site_fields};
static const field_word site_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};

static const field_word atmosphere_words[] = {{"us1976", LD_ATMOSPHERE_US1976},
                                              {"none", LD_ATMOSPHERE_NONE},
                                              {"", LD_ATMOSPHERE_UNIFORM},
                                              {"", LD_ATMOSPHERE_PROFILE},
                                              {NULL, 0}};
static const field_word atmosphere_forms[] = {{"uniform air", LD_ATMOSPHERE_UNIFORM},
                                              {"a profile of the air", LD_ATMOSPHERE_PROFILE},
                                              {NULL, 0}};
#define AIR_COLUMNS                                                                                \
    {"height", .unit = "m", FROM_TO(-5000, 86000)}, {"pressure", .unit = "Pa", FROM_TO(0.1, 2e5)}, \
    {                                                                                              \
        "temperature", .unit = "K", FROM_TO(100, 400)                                              \
    }
static const field_row dry_air_columns[] = {AIR_COLUMNS};
static const field_row air_columns[] = {AIR_COLUMNS, {"humidity", .unit = "", FROM_TO(0, 1)}};
static const table_format air_table = {TABLE_CSV | TABLE_BARE | TABLE_SOUNDING, 4, air_columns,
                                       NULL};
static const table_format dry_air_table = {TABLE_CSV | TABLE_BARE | TABLE_SOUNDING, 3,
                                           dry_air_columns, &air_table};
#define UNIFORM_AIR .forms = FORM(LD_ATMOSPHERE_UNIFORM)
static const field_row atmosphere_fields[] = {
    {"density", NUMBER(ld_atmosphere, density, "kg/m3"), FROM_TO(0, 1000), REQUIRED, UNIFORM_AIR,
     .doc = "the same everywhere"},
    {"speed_of_sound", NUMBER(ld_atmosphere, speed_of_sound, "m/s"), ABOVE_TO(0, 1e5), REQUIRED,
     UNIFORM_AIR, .doc = "the same everywhere"},
    {"profile", TABLE(ld_atmosphere, profile, dry_air_table), .required = true,
     .forms = FORM(LD_ATMOSPHERE_PROFILE),
     .doc = "measured air over the altitude, with relative humidity over water or dry; outside its "
            "rows us1976, scaled to continue"},
    {0}};
static const field_block atmosphere_block = {.fields = atmosphere_fields,
                                             .form = atmosphere_forms,
                                             .form_offset = offsetof(ld_atmosphere, kind),
                                             .form_from_keys = true};

static const field_row gust_fields[] = {
    {"start", NUMBER(ld_gust, start, "s"), FROM_TO(-10000, 10000), REQUIRED,
     .doc = "on the run's clock"},
    {"rise", NUMBER(ld_gust, rise, "s"), ABOVE_TO(0, 10000), REQUIRED,
     .doc = "half a cosine up to the full speed"},
    {"hold", NUMBER(ld_gust, hold, "s"), FROM_TO(0, 10000), DEFAULT(0), .doc = "at the full speed"},
    {"fall", NUMBER(ld_gust, fall, "s"), ABOVE_TO(0, 10000), NO_DEFAULT("as rise"),
     .doc = "half a cosine down to 0"},
    {"speed", NUMBER(ld_gust, speed, "m/s"), FROM_TO(-1000, 1000), REQUIRED, .doc = "full speed"},
    {"heading", NUMBER(ld_gust, heading, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .doc = "direction to which it blows, as of the wind"},
    {0}};
static const field_block gust_block = {.fields = gust_fields};

static const field_word turbulence_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word turbulence_models[] = {{"dryden", LD_TURBULENCE_DRYDEN}, {NULL, 0}};
static const field_row turbulence_fields[] = {
    {"model", CHOICE(ld_turbulence, model, turbulence_models), DEFAULT(LD_TURBULENCE_DRYDEN),
     .doc = "Dryden spectra with the scales and intensities of MIL-F-8785C"},
    {"wind_at_6m", NUMBER(ld_turbulence, wind_at_6m, "m/s"), FROM_TO(0, 100), REQUIRED,
     .doc = "wind speed at 20 ft, which sets the intensity; adds no wind"},
    {"seed", INTEGER(ld_turbulence, seed, 0, 999999999), DEFAULT(1),
     .doc = "of phases and wave numbers"},
    {"harmonics", INTEGER(ld_turbulence, harmonics, 1, 1000), DEFAULT(100),
     .doc = "cells of each spectrum"},
    {0}};
static const field_block turbulence_block = {.fields = turbulence_fields};

static const field_row wind_columns[] = {
    {"height", .unit = "m", FROM_TO(-1e4, 1e6)},
    {"x", .unit = "m/s", FROM_TO(-1000, 1000)},
    {"z", .unit = "m/s", FROM_TO(-1000, 1000)},
};
static const table_format wind_table = {TABLE_CSV | TABLE_BARE | TABLE_SOUNDING, 3, wind_columns,
                                        NULL};
static const field_word wind_axes[] = {
    {"launcher", LD_WIND_LAUNCHER}, {"geographic", LD_WIND_GEOGRAPHIC}, {NULL, 0}};
static const field_word wind_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row wind_fields[] = {
    {"axes", CHOICE(ld_wind, axes, wind_axes), DEFAULT(LD_WIND_LAUNCHER),
     .doc = "headings from x of I and heights above ground, or headings from north and altitudes; "
            "clockwise"},
    {"speed", NUMBER(ld_wind, speed, "m/s"), FROM_TO(-1000, 1000), DEFAULT(0),
     .doc = "at every height, in place of a profile"},
    {"heading", NUMBER(ld_wind, heading, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .doc = "direction to which the air moves; 0: tail wind along x"},
    {"profile", TABLE(ld_wind, profile, wind_table), .other = offsetof(ld_wind, axes),
     .initial_doc = "none",
     .doc = "velocity along x and z over height (geographic: north and east over altitude), pchip, "
            "constant outside"},
    {"scale", NUMBER(ld_wind, scale, ""), FROM_TO(-1000, 1000), DEFAULT(1),
     .doc = "factor on speed or profile"},
    {"add", VECTOR(ld_wind, add, "m/s", 3), FROM_TO(-1000, 1000), DEFAULT(0),
     .doc = "added velocity along x, y, z (geographic: north, up, east)"},
    {"gust", LIST(ld_wind, gust, gust_count, gust_block, 0, LD_MAX_GUSTS), .initial_doc = "none",
     .doc = "gusts, uniform in space"},
    {"turbulence", BLOCK(ld_wind, turbulence, turbulence_block), .initial_doc = "none",
     SWITCH(ld_wind, turbulence.present, turbulence_words), .other_is_bool = true,
     .doc = "random gusts, frozen in the air"},
    {0}};
static const field_block wind_block = {.fields = wind_fields};

static const field_word ground_words[] = {
    {"", LD_GROUND_PLANE}, {"none", LD_GROUND_NONE}, {NULL, 0}};

static const field_row environment_fields[] = {
    {"earth", BLOCK(ld_model, environment.earth, earth_block), .initial_doc = "flat",
     SWITCH(ld_model, environment.earth.kind, earth_words),
     .doc = "Earth in free flight; flat: I is inertial, gravity constant"},
    {"gravity", NUMBER(ld_model, gravity, "m/s2"), FROM_TO(0, 100), DEFAULT(9.80665),
     .doc = "along -y of I; in free flight: of a flat Earth"},
    {"site", BLOCK(ld_model, environment.site, site_block), .initial_doc = "none",
     SWITCH(ld_model, environment.site.present, site_words), .other_is_bool = true,
     .doc = "position of I's origin on the Earth; none: the defaults, and no map on a flat Earth"},
    {"atmosphere", BLOCK(ld_model, environment.atmosphere, atmosphere_block),
     .initial_doc = "us1976", SWITCH(ld_model, environment.atmosphere.kind, atmosphere_words),
     .doc = "air: US Standard Atmosphere 1976, uniform or measured"},
    {"density_scale", NUMBER(ld_model, environment.atmosphere.density_scale, ""), FROM_TO(0, 1000),
     DEFAULT(1), .doc = "factor on the density of the air"},
    {"temperature_offset", NUMBER(ld_model, environment.atmosphere.temperature_offset, "K"),
     FROM_TO(-100, 100), DEFAULT(0),
     .doc = "added to the temperature of us1976 or profile, at unchanged pressure"},
    {"ground", CHOICE(ld_model, environment.ground, ground_words),
     .other = offsetof(ld_model, environment.ground_height), .unit = "m",
     .range = {-1e5, 1e7, 0, 0}, .initial_doc = "0 m, or the site's altitude",
     DEFAULT(LD_GROUND_PLANE),
     .doc = "where free flight ends: y on a flat Earth, else height above sphere or ellipsoid"},
    {"wind", BLOCK(ld_model, environment.wind, wind_block), .initial_doc = "none",
     SWITCH(ld_model, environment.wind.present, wind_words), .other_is_bool = true,
     .doc = "velocity of the air"},
    {0}};
static const field_block environment_block = {.fields = environment_fields};

// ---- prescribed motion

static const field_row length_sine_fields[] = {
    {"amplitude", NUMBER(ld_sine, amplitude, "m"), ANY, REQUIRED, .doc = "amplitude"},
    {"frequency", NUMBER(ld_sine, frequency, "Hz"), FROM_TO(0, 10000), REQUIRED,
     .doc = "cycles per second"},
    {"phase", NUMBER(ld_sine, phase, "rad"), ANY, DEFAULT(0), .doc = "phase at t = 0"},
    {0}};
static const field_row angle_sine_fields[] = {
    {"amplitude", NUMBER(ld_sine, amplitude, "rad"), ANY, REQUIRED, .doc = "amplitude"},
    {"frequency", NUMBER(ld_sine, frequency, "Hz"), FROM_TO(0, 10000), REQUIRED,
     .doc = "cycles per second"},
    {"phase", NUMBER(ld_sine, phase, "rad"), ANY, DEFAULT(0), .doc = "phase at t = 0"},
    {0}};
static const field_block length_sine_block = {.fields = length_sine_fields};
static const field_block angle_sine_block = {.fields = angle_sine_fields};

static const field_row motion_columns[] = {
    {"t", .unit = "s", ANY},      {"x", .unit = "m", ANY},     {"y", .unit = "m", ANY},
    {"z", .unit = "m", ANY},      {"yaw", .unit = "rad", ANY}, {"pitch", .unit = "rad", ANY},
    {"roll", .unit = "rad", ANY},
};
static const field_row turned_columns[] = {
    {"t", .unit = "s", ANY}, {"x", .unit = "m", ANY}, {"y", .unit = "m", ANY},
    {"z", .unit = "m", ANY}, {"q0", .unit = "", ANY}, {"q1", .unit = "", ANY},
    {"q2", .unit = "", ANY}, {"q3", .unit = "", ANY},
};
static const table_format turned_table = {TABLE_CSV | TABLE_CLOCK | TABLE_QUATERNION, 8,
                                          turned_columns, NULL};
static const table_format motion_table = {TABLE_CSV | TABLE_CLOCK, 7, motion_columns,
                                          &turned_table};

#define SINES(member, block_)                                                                      \
    LIST(ld_base, member.term, member.count, block_, 0, LD_MAX_SINES), .initial_doc = "none"
static const field_row motion_fields[] = {
    {"surge", SINES(surge, length_sine_block), .doc = "sum of sines along x of I"},
    {"heave", SINES(heave, length_sine_block), .doc = "sum of sines along y of I"},
    {"sway", SINES(sway, length_sine_block), .doc = "sum of sines along z of I"},
    {"yaw", SINES(yaw, angle_sine_block), .doc = "sum of sines, about +y"},
    {"pitch", SINES(pitch, angle_sine_block), .doc = "sum of sines, about +z"},
    {"roll", SINES(roll, angle_sine_block), .doc = "sum of sines, about +x"},
    {"table", TABLE(ld_base, motion, motion_table), .other = offsetof(ld_base, motion_origin),
     .initial_doc = "none",
     .doc = "pose over time in place of sines and velocity, cubic spline; q0: scalar part of the "
            "quaternion"},
    {"start", NUMBER(ld_base, motion_start, "s"), ANY, DEFAULT(0),
     .doc = "time of the table at 0 of the run's clock"},
    {0}};
static const field_block motion_block = {.fields = motion_fields};

// ---- sea

#define AMPLITUDE(name_, unit_)                                                                    \
    {                                                                                              \
        name_, .unit = unit_, NOT_NEGATIVE                                                         \
    }
#define LEAD(name_)                                                                                \
    {                                                                                              \
        name_, .unit = "rad", ANY                                                                  \
    }
static const field_row response_columns[] = {
    {"omega", .unit = "rad/s", NOT_NEGATIVE},
    AMPLITUDE("surge", ""),
    LEAD("surge_phase"),
    AMPLITUDE("sway", ""),
    LEAD("sway_phase"),
    AMPLITUDE("heave", ""),
    LEAD("heave_phase"),
    AMPLITUDE("roll", "rad/m"),
    LEAD("roll_phase"),
    AMPLITUDE("pitch", "rad/m"),
    LEAD("pitch_phase"),
    AMPLITUDE("yaw", "rad/m"),
    LEAD("yaw_phase"),
};
static const table_format response_table = {TABLE_CSV, 13, response_columns, NULL};
static const field_row response_fields[] = {
    {"heading", NUMBER(ld_sea_response, heading, "rad"), FROM_TO(0, PI), NO_DEFAULT("the sea's"),
     .doc = "of the waves, from x; to the left sway, roll and yaw change sign"},
    {"table", TABLE(ld_sea_response, table, response_table), .required = true,
     .doc = "over the wave frequency: amplitude per wave amplitude, phase lead on the crest at the "
            "base's origin; complex linear, constant below, 0 above"},
    {0}};
static const field_block response_block = {.fields = response_fields};
static const field_word spectrum_words[] = {{"jonswap", LD_SEA_JONSWAP},
                                            {"pierson_moskowitz", LD_SEA_PIERSON_MOSKOWITZ},
                                            {"regular", LD_SEA_REGULAR},
                                            {NULL, 0}};
static const field_word sea_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row sea_fields[] = {
    {"spectrum", CHOICE(ld_sea, spectrum, spectrum_words), DEFAULT(LD_SEA_JONSWAP),
     .doc = "of the water's height; `regular`: one wave, crest at the base's origin at t = 0"},
    {"height", NUMBER(ld_sea, height, "m"), FROM_TO(0, 100), REQUIRED,
     .doc = "significant height, four times the rms; of one wave trough to crest"},
    {"period", NUMBER(ld_sea, period, "s"), FROM_TO(0.1, 1000), REQUIRED,
     .doc = "of the spectrum's peak, or of the wave"},
    {"peakedness", NUMBER(ld_sea, peakedness, ""), FROM_TO(1, 20), DEFAULT(3.3),
     .doc = "gamma of JONSWAP"},
    {"heading", NUMBER(ld_sea, heading, "rad"), FROM_TO(-2 * PI, 2 * PI), REQUIRED,
     .doc = "direction to which the waves travel, from x of I, positive to the right; 180 deg: "
            "head sea"},
    {"spreading", NUMBER(ld_sea, spreading, ""), FROM_TO(0.5, 1000),
     NO_DEFAULT("all waves go there"), .doc = "s of the density cos^2s(angle/2) of the headings"},
    {"waves", INTEGER(ld_sea, waves, 1, 10000), DEFAULT(200),
     .doc = "number of waves, in cells of equal frequency ratio"},
    {"seed", INTEGER(ld_sea, seed, 0, 999999999), DEFAULT(1),
     .doc = "of frequencies, phases and headings"},
    {"responses", LIST(ld_sea, response, response_count, response_block, 1, LD_MAX_SEA_RESPONSES),
     .required = true, .doc = "of the ship over rising headings; complex linear between"},
    {0}};
static const field_block sea_block = {.fields = sea_fields};

// ---- vehicle

static const field_word class_words[] = {{"none", LD_ROAD_SMOOTH},
                                         {"A", 0},
                                         {"B", 1},
                                         {"C", 2},
                                         {"D", 3},
                                         {"E", 4},
                                         {"F", 5},
                                         {"G", 6},
                                         {"H", 7},
                                         {NULL, 0}};
static const field_word tracks_words[] = {{"same", LD_TRACKS_SAME},
                                          {"independent", LD_TRACKS_INDEPENDENT},
                                          {"coherent", LD_TRACKS_COHERENT},
                                          {NULL, 0}};
static const field_word track_words[] = {
    {"both", LD_TRACK_BOTH}, {"left", LD_TRACK_LEFT}, {"right", LD_TRACK_RIGHT}, {NULL, 0}};
static const field_word true_words[] = {{"true", 1}, {NULL, 0}};
static const field_word road_forms[] = {
    {"a flat road", LD_ROAD_FLAT}, {"a road with a profile", LD_ROAD_SUM}, {NULL, 0}};

static const field_row coherence_columns[] = {
    {"n", .unit = "1/m", NOT_NEGATIVE},
    {"g", .unit = "", FROM_TO(0, 1)},
};
static const table_format coherence_table = {0, 2, coherence_columns, NULL};

// What is shorter no tyre meets, and it takes a run for ever.
#define ROAD_WAVELENGTH FROM_TO(1e-3, 1e5)

static const field_row road_sine_fields[] = {
    {"amplitude", NUMBER(ld_road_sine, amplitude, "m"), FROM_TO(-10, 10), REQUIRED,
     .doc = "amplitude"},
    {"wavelength", NUMBER(ld_road_sine, wavelength, "m"), ROAD_WAVELENGTH, REQUIRED,
     .doc = "wavelength"},
    {"phase", NUMBER(ld_road_sine, phase, "rad"), ANY, DEFAULT(0), .doc = "phase at x = 0"},
    {0}};
static const field_block road_sine_block = {.fields = road_sine_fields};

static const field_row bump_fields[] = {
    {"at", NUMBER(ld_bump, at, "m"), ANY, REQUIRED, .doc = "x of I where it begins"},
    {"length", NUMBER(ld_bump, length, "m"), POSITIVE, REQUIRED, .doc = "length"},
    {"height", NUMBER(ld_bump, height, "m"), FROM_TO(-10, 10), REQUIRED,
     .doc = "height of the half-cosine up and down; negative: a hole"},
    {"tracks", CHOICE(ld_bump, tracks, track_words), DEFAULT(LD_TRACK_BOTH),
     .doc = "under which wheels"},
    {0}};
static const field_block bump_block = {.fields = bump_fields};

static const field_row profile_columns[] = {{"x", .unit = "m", ANY},
                                            {"h", .unit = "m", FROM_TO(-100, 100)}};
static const field_row tracks_columns[] = {{"x", .unit = "m", ANY},
                                           {"left", .unit = "m", FROM_TO(-100, 100)},
                                           {"right", .unit = "m", FROM_TO(-100, 100)}};
static const table_format tracks_table = {TABLE_CSV, 3, tracks_columns, NULL};
static const table_format profile_table = {TABLE_CSV, 2, profile_columns, &tracks_table};

#define SUM .forms = FORM(LD_ROAD_SUM)
static const double road_wavelengths[] = {0.3, 100};
static const field_row road_fields[] = {
    {"flat", .kind = FIELD_CHOICE, .offset = FIELD_NOWHERE, .words = true_words,
     .initial_doc = "not flat", .forms = FORM(LD_ROAD_FLAT), .doc = "height 0 everywhere"},
    {"class", CHOICE(ld_road, iso_class, class_words), DEFAULT(LD_ROAD_SMOOTH), SUM,
     .doc = "random part: class of ISO 8608"},
    {"tracks", CHOICE(ld_road, tracks, tracks_words), DEFAULT(LD_TRACKS_SAME), SUM,
     .doc = "random part of left (wheels with mount z < 0) and right track: same, independent, or "
            "coherent by the table"},
    {"coherence", TABLE(ld_road, coherence, coherence_table), .initial_doc = "none", SUM,
     .doc = "with `tracks: coherent`: coherence g^2 over spatial frequency (linear between rows, "
            "constant outside)"},
    {"seed", INTEGER(ld_road, seed, 0, 999999999), DEFAULT(1), SUM, .doc = "of the random part"},
    {"harmonics", INTEGER(ld_road, harmonics, 1, 100000), DEFAULT(400), SUM,
     .doc = "cosines of the random part, in bands of equal frequency ratio"},
    {"wavelengths", VECTOR(ld_road, wavelengths, "m", 2), ROAD_WAVELENGTH, DEFAULT(0.3),
     .initials = road_wavelengths, SUM, .doc = "shortest and longest of the random part"},
    {"sines", LIST(ld_road, sine, sine_count, road_sine_block, 0, LD_MAX_SINES),
     .initial_doc = "none", SUM, .doc = "sum of sines over x of I, on both tracks"},
    {"bumps", LIST(ld_road, bump, bump_count, bump_block, 0, LD_MAX_BUMPS), .initial_doc = "none",
     SUM, .doc = "bumps and holes"},
    {"table", TABLE(ld_road, profile, profile_table), .initial_doc = "none", SUM,
     .doc = "measured profile of both tracks or each (cubic spline, constant outside)"},
    {"places", VECTOR(ld_road, places, "m", 2), FROM_TO(-1000, 1000),
     NO_DEFAULT("track of each wheel's side"), SUM,
     .doc = "z of left and right track in chassis axes: height linear between, that of the nearer "
            "track beyond"},
    {0}};
static const field_block road_block = {.fields = road_fields,
                                       .form = road_forms,
                                       .form_offset = offsetof(ld_road, form),
                                       .form_from_keys = true};

static const field_row wheel_fields[] = {
    {"name", WORD(ld_wheel, name), .required = true, .doc = "name in results and paths"},
    {"mount", VECTOR(ld_wheel, mount, "m", 3), FROM_TO(-1000, 1000), REQUIRED,
     .doc =
         "wheel centre with unloaded suspension, in chassis axes from the chassis' mass centre; in "
         "axes of `base.wheels_on` from its origin"},
    {"mass", NUMBER(ld_wheel, mass, "kg"), POSITIVE, REQUIRED, .doc = "mass"},
    {0}};
static const field_block wheel_block = {.fields = wheel_fields};

static const field_row drive_fields[] = {
    {"kp", NUMBER(ld_base, vehicle.drive.kp, "N.s/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "gain on the speed error"},
    {"ki", NUMBER(ld_base, vehicle.drive.ki, "N/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "gain on its integral"},
    {"wheels", SELECTION(ld_base, vehicle.wheel, vehicle.wheel_count, ld_wheel, driven),
     .initial_doc = "all", .doc = "the driven wheels"},
    {0}};
static const field_block drive_block = {.fields = drive_fields};

static const field_row bump_stop_fields[] = {
    {"compression", NUMBER(ld_suspension, bump_stop.compression, "m"), POSITIVE, NO_DEFAULT("none"),
     .doc = "upward travel from unloaded at which the stop begins"},
    {"extension", NUMBER(ld_suspension, bump_stop.extension, "m"), POSITIVE, NO_DEFAULT("none"),
     .doc = "downward travel at which the stop begins"},
    {"stiffness", NUMBER(ld_suspension, bump_stop.stiffness, "N/m"), POSITIVE,
     NO_DEFAULT("required by a stop"), .doc = "added beyond"},
    {0}};
static const field_block bump_stop_block = {.fields = bump_stop_fields};

static const field_row suspension_fields[] = {
    {"stiffness", VECTOR(ld_suspension, stiffness, "N/m", 3), POSITIVE, REQUIRED,
     .doc = "along x, y, z of the chassis"},
    {"damping", VECTOR(ld_suspension, damping, "N.s/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "along x, y, z"},
    {"bump_stop", SAME_STRUCT(bump_stop_block), .initial_doc = "none",
     .doc = "spring beyond a travel along y"},
    {0}};
static const field_block suspension_block = {.fields = suspension_fields};

static const field_row tyre_fields[] = {
    {"radius", NUMBER(ld_tyre, radius, "m"), ABOVE_TO(0, 100), REQUIRED, .doc = "unloaded"},
    {"stiffness", VECTOR(ld_tyre, stiffness, "N/m", 3), POSITIVE, REQUIRED,
     .doc = "along, vertical, across"},
    {"damping", VECTOR(ld_tyre, damping, "N.s/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "along, vertical, across"},
    {"relaxation_length", NUMBER(ld_tyre, relaxation_length, "m"), POSITIVE, REQUIRED,
     .doc = "distance over which lateral force builds up"},
    {"friction", NUMBER(ld_tyre, friction, ""), ABOVE_TO(0, 10), REQUIRED,
     .doc = "Coulomb coefficient between tyre and road"},
    {0}};
static const field_block tyre_block = {.fields = tyre_fields};

// ---- base

#define BASE_WORD(name, word, number) {#word, name},
static const field_word base_words[] = {LD_BASE_KINDS(BASE_WORD){NULL, 0}};
static const field_word extrapolation_words[] = {{"acceleration", LD_EXTRAPOLATION_ACCELERATION},
                                                 {"velocity", LD_EXTRAPOLATION_VELOCITY},
                                                 {NULL, 0}};
static const field_word looks_words[] = {
    {"plain", LD_LOOKS_PLAIN}, {"ship", LD_LOOKS_SHIP}, {"aircraft", LD_LOOKS_AIRCRAFT}, {NULL, 0}};
#define FIXED_OR_PRESCRIBED (FORM(LD_BASE_FIXED) | FORM(LD_BASE_PRESCRIBED))
#define VEHICLE FORM(LD_BASE_VEHICLE)
#define EXTERNAL FORM(LD_BASE_EXTERNAL)
#define FMU FORM(LD_BASE_FMU)
#define MULTIBODY FORM(LD_BASE_MULTIBODY)
#define MOVED (FORM(LD_BASE_PRESCRIBED) | MULTIBODY)
#define PARTS(part, block_, least, most, text)                                                     \
    LIST(ld_base, mechanism.part, mechanism.part##_count, block_, least, most),                    \
        .silent = true, .initial_doc = "none", .forms = MULTIBODY, .doc = text

#define NAMES(member) .kind = FIELD_TEXT, .offset = offsetof(ld_base, fmu.connect.member)
static const field_row connect_fields[] = {
    {"position", NAMES(position), .initial_doc = "base.position.x base.position.y base.position.z",
     .doc = "outputs: origin x, y, z in I of the frame that the FMU reports"},
    {"quaternion", NAMES(quaternion), .initial_doc = "base.quaternion.0 to .3",
     .doc = "outputs: its axes against I, scalar first"},
    {"angles", NAMES(angles), .initial_doc = "none",
     .doc = "outputs in place of it: yaw, pitch, roll of Ry(yaw) Rz(pitch) Rx(roll)"},
    {"velocity", NAMES(velocity), .initial_doc = "base.velocity.x to .z",
     .doc = "outputs: velocity of the origin in I"},
    {"angular_rate", NAMES(angular_rate), .initial_doc = "base.rate.x to .z",
     .doc = "outputs: angular velocity"},
    {"force", NAMES(force), .initial_doc = "input.wrench.force.x to .z",
     .doc = "inputs: force in I at the frame's origin"},
    {"moment", NAMES(moment), .initial_doc = "input.wrench.moment.x to .z",
     .doc = "inputs: moment in I about it"},
    {0}};
static const field_block connect_block = {.fields = connect_fields};
static const field_row fmu_parameter_fields[] = {
    {"name", .kind = FIELD_TEXT, .offset = offsetof(ld_fmu_parameter, name), .required = true,
     .doc = "of the FMU's variable"},
    {"value", NUMBER(ld_fmu_parameter, value, ""), ANY, NO_DEFAULT("none"),
     .doc = "number, in the FMU's unit; 0 or 1 for a Boolean"},
    {"text", .kind = FIELD_TEXT, .offset = offsetof(ld_fmu_parameter, text), .initial_doc = "none",
     .doc = "text in place of a number"},
    {0}};
static const field_block fmu_parameter_block = {.fields = fmu_parameter_fields};
static const field_word inputs_words[] = {{"held", LD_FMU_HELD},
                                          {"ramped", LD_FMU_RAMPED},
                                          {"extrapolated", LD_FMU_EXTRAPOLATED},
                                          {NULL, 0}};
static const field_word axes_words[] = {
    {"inertial", LD_FMU_AXES_OF_I}, {"body", LD_FMU_AXES_OF_BODY}, {NULL, 0}};
#define WITH_WHEELS .counted = offsetof(ld_base, vehicle.wheel_count)
#define WITHOUT_WHEELS "none with `multibody`"
static const field_row base_fields[] = {
    {"kind", CHOICE(ld_base, kind, base_words), .required = true, .doc = "base of the tube"},
    {"azimuth", NUMBER(ld_base, azimuth, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .forms = FIXED_OR_PRESCRIBED | FMU | MULTIBODY,
     .doc = "of the tube against the base, positive to the left"},
    {"elevation", NUMBER(ld_base, elevation, "rad"), FROM_TO(-PI / 2, PI / 2), DEFAULT(0),
     .forms = FIXED_OR_PRESCRIBED | FMU | MULTIBODY,
     .doc = "of the tube against the base, positive up"},
    {"velocity", VECTOR(ld_base, velocity, "m/s", 3), ANY, DEFAULT(0), .forms = MOVED,
     .doc = "constant velocity along I, added to the sines"},
    {"motion", SAME_STRUCT(motion_block), .forms = MOVED, .initial_doc = "none",
     .doc = "position and orientation Ry(yaw) Rz(pitch) Rx(roll) over time"},
    {"sea", BLOCK(ld_base, sea, sea_block), .forms = MOVED, .initial_doc = "none",
     SWITCH(ld_base, sea.present, sea_words), .other_is_bool = true,
     .doc = "waves on deep water and the ship's response, added to velocity and sines"},
    {"speed", NUMBER(ld_base, vehicle.speed, "m/s"), FROM_TO(0, 1000), REQUIRED,
     .forms = VEHICLE | MULTIBODY, .optional = MULTIBODY, WITH_WHEELS,
     .initial_doc = WITHOUT_WHEELS, .doc = "marching speed, kept by the drive; 0: parked"},
    {"road", BLOCK(ld_base, vehicle.road, road_block), .required = true,
     .forms = VEHICLE | MULTIBODY, .optional = MULTIBODY, WITH_WHEELS,
     .initial_doc = WITHOUT_WHEELS, .doc = "height over x of I: flat, or the sum of what is given"},
    {"wheels", LIST(ld_base, vehicle.wheel, vehicle.wheel_count, wheel_block, 1, LD_MAX_WHEELS),
     .required = true, .forms = VEHICLE | MULTIBODY, .optional = MULTIBODY, WITH_WHEELS,
     .initial_doc = WITHOUT_WHEELS, .doc = "masses on suspensions and tyres, all alike"},
    {"drive", SAME_STRUCT(drive_block), .forms = VEHICLE | MULTIBODY, WITH_WHEELS,
     .initial_doc = WITHOUT_WHEELS,
     .doc = "force that keeps the speed, equal on all driven wheels; required if `speed` is not 0"},
    {"suspension", BLOCK(ld_base, vehicle.suspension, suspension_block), .required = true,
     .forms = VEHICLE | MULTIBODY, .optional = MULTIBODY, WITH_WHEELS,
     .initial_doc = WITHOUT_WHEELS, .doc = "spring-damper between chassis and each wheel"},
    {"tyre", BLOCK(ld_base, vehicle.tyre, tyre_block), .required = true,
     .forms = VEHICLE | MULTIBODY, .optional = MULTIBODY, WITH_WHEELS,
     .initial_doc = WITHOUT_WHEELS, .doc = "between each wheel and the road"},
    {"extrapolation", CHOICE(ld_base, extrapolation, extrapolation_words),
     DEFAULT(LD_EXTRAPOLATION_ACCELERATION), .forms = EXTERNAL,
     .doc =
         "between reports: by the acceleration of the last two velocities, or the last velocity"},
    {"digest", .kind = FIELD_TEXT, .offset = offsetof(ld_base, fmu.digest), .forms = FMU,
     .initial_doc = "that of the file",
     .doc = "of the file, as in results: another file is an error"},
    {"file", .kind = FIELD_FILE, .offset = offsetof(ld_base, fmu.file),
     .other = offsetof(ld_base, fmu.digest), .required = true, .forms = FMU,
     .doc = "FMU for co-simulation (FMI 2.0 or 3.0), relative to the scenario's folder"},
    {"step", NUMBER(ld_base, fmu.step, "s"), ABOVE_TO(0, 1), REQUIRED, .forms = FMU,
     .doc = "between exchanges of pose and wrench, from the run's start"},
    {"inputs", CHOICE(ld_base, fmu.inputs, inputs_words), DEFAULT(LD_FMU_HELD), .forms = FMU,
     .doc = "use within a step: `held` (the FMU receives the extrapolated mean wrench), `ramped` "
            "(also its rate; FMI 2.0) or `extrapolated` by the FMU (it receives the last wrench)"},
    {"connect", SAME_STRUCT(connect_block), .forms = FMU, .initial_doc = "as below",
     .doc = "names of the FMU's variables, separated by blanks"},
    {"rate_axes", CHOICE(ld_base, fmu.rate_axes, axes_words), DEFAULT(LD_FMU_AXES_OF_I),
     .forms = FMU, .doc = "axes of the reported angular velocity"},
    {"at", VECTOR(ld_base, at, "m", 3), ANY, DEFAULT(0), .forms = FORM(LD_BASE_PRESCRIBED) | FMU,
     .doc = "rear end of the undeformed tube in the base's frame"},
    {"parameters",
     LIST(ld_base, fmu.parameter, fmu.parameter_count, fmu_parameter_block, 0,
          LD_MAX_FMU_PARAMETERS),
     .silent = true, .forms = FMU, .initial_doc = "none",
     .doc = "of the FMU, and start values, set before its initialization"},
    {"start_time", NUMBER(ld_base, fmu.start_time, "s"), FROM_TO(-1e6, 1e6), DEFAULT(0),
     .forms = FMU, .doc = "of the FMU's clock at the run's start (with lead_in)"},
    {"time_limit", NUMBER(ld_base, fmu.time_limit, "s"), ABOVE_TO(0, 1e5), DEFAULT(60),
     .forms = FMU, .doc = "longest duration of one call"},
    {"bodies", PARTS(body, body_block, 0, LD_MAX_BODIES, "rigid bodies")},
    {"beams", PARTS(beam, beam_block, 0, LD_MAX_BEAMS, "flexible beams")},
    {"joints", PARTS(joint, joint_block, 1, LD_MAX_JOINTS,
                     "what carries each body and beam, and what closes loops")},
    {"bushings", PARTS(bushing, bushing_block, 0, LD_MAX_BUSHINGS,
                       "springs and dampers in all six directions between two bodies")},
    {"struts", PARTS(strut, strut_block, 0, LD_MAX_STRUTS,
                     "springs, dampers and actuators between two points")},
    {"drives", PARTS(drive, joint_drive_block, 0, LD_MAX_DRIVES, "stabilisers on joints")},
    {"feet", PARTS(foot, foot_block, 0, LD_MAX_FEET, "jacks on the ground")},
    {"loads", PARTS(load, load_block, 0, LD_MAX_LOADS, "forces and moments over time")},
    {"drag", PARTS(drag, drag_block, 0, LD_MAX_DRAGS, "of the wind on bodies")},
    {"wheels_on", WORD(ld_base, mechanism.wheels_on), .forms = MULTIBODY, .initial_doc = "none",
     .doc = "body that the wheels carry, in whose axes they are mounted"},
    {"looks", CHOICE(ld_base, looks, looks_words), DEFAULT(LD_LOOKS_PLAIN),
     .forms = FIXED_OR_PRESCRIBED | EXTERNAL | FMU | MULTIBODY,
     .doc = "appearance in the replay; of a multibody base that of its carrier"},
    {0}};
static const field_block base_block = {.fields = base_fields,
                                       .form = base_words,
                                       .form_offset = offsetof(ld_base, kind),
                                       .form_key = "kind"};

// ---- platform

static const field_row chassis_fields[] = {
    {"mass", NUMBER(ld_platform, chassis_mass, "kg"), POSITIVE, REQUIRED,
     .doc = "without wheels and platforms"},
    {"inertia", VECTOR(ld_platform, chassis_inertia, "kg.m2", 3), POSITIVE, REQUIRED,
     .doc = "about its mass centre, the origin of chassis axes"},
    {0}};
static const field_block chassis_block = {.fields = chassis_fields};

static const field_row friction_fields[] = {
    {"viscous", NUMBER(ld_hinge_friction, viscous, "N.m.s/rad"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "viscous friction"},
    {"coulomb", NUMBER(ld_hinge_friction, coulomb, "N.m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "Coulomb friction"},
    {"rate", NUMBER(ld_hinge_friction, rate, "rad/s"), POSITIVE, DEFAULT(1e-3),
     .doc = "at which Coulomb friction reaches 71 %"},
    {0}};
static const field_block friction_block = {.fields = friction_fields};

static const field_row hinge_lock_fields[] = {
    {"stiffness", NUMBER(ld_hinge_lock, stiffness, "N.m/rad"), POSITIVE, REQUIRED,
     .doc = "about the hinge, from the equilibrium"},
    {"damping", NUMBER(ld_hinge_lock, damping, "N.m.s/rad"), NOT_NEGATIVE, REQUIRED,
     .doc = "about the hinge"},
    {0}};
static const field_block hinge_lock_block = {.fields = hinge_lock_fields};
static const field_word optional_block_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};

static const field_row turret_fields[] = {
    {"hinge_at", VECTOR(ld_turret, hinge_at, "m", 3), FROM_TO(-1000, 1000), REQUIRED,
     .doc = "hinge in axes of the body below: from the chassis' mass centre, of elevation from the "
            "azimuth hinge if there is one"},
    {"mass", NUMBER(ld_turret, mass, "kg"), POSITIVE, REQUIRED,
     .doc = "of the frame, without tubes, tails and rockets"},
    {"center", VECTOR(ld_turret, center, "m", 3), FROM_TO(-1000, 1000), REQUIRED,
     .doc = "mass centre of the frame from its hinge"},
    {"inertia", VECTOR(ld_turret, inertia, "kg.m2", 3), POSITIVE, REQUIRED,
     .doc = "of the frame about its mass centre"},
    {"stabiliser", BLOCK(ld_turret, stabiliser, stabiliser_block), .required = true,
     .doc = "torque kp error + kd rate + ki integral, limited; or as its options say"},
    {"friction", BLOCK(ld_turret, friction, friction_block), .initial_doc = "none",
     .doc = "in the hinge"},
    {"lock", BLOCK(ld_turret, lock, hinge_lock_block), .initial_doc = "none",
     SWITCH(ld_turret, lock.present, optional_block_words), .other_is_bool = true,
     .doc = "spring-damper in place of the stabiliser"},
    {0}};
static const field_block turret_block = {.fields = turret_fields};

static const field_row jet_columns[] = {
    {"distance", .unit = "m", FROM_TO(0, 1000)},
    {"force", .unit = "N", NOT_NEGATIVE},
};
static const table_format jet_table = {TABLE_CSV, 2, jet_columns, NULL};
static const field_row platform_fields[] = {
    {"chassis", SAME_STRUCT(chassis_block), .required = true, .doc = "free rigid body"},
    {"azimuth", BLOCK(ld_platform, azimuth, turret_block), .initial_doc = "none",
     SWITCH(ld_platform, has_azimuth, optional_block_words), .other_is_bool = true,
     .doc = "platform about the chassis' y axis"},
    {"elevation", BLOCK(ld_platform, elevation, turret_block), .required = true,
     .doc = "platform about the z axis of the azimuth platform, or of the chassis without one; "
            "carries the tubes"},
    {"jet", TABLE(ld_platform, jet, jet_table), .initial_doc = "none",
     .doc = "force of a departed rocket's jet, backwards on the elevation platform at the tip, at "
            "greatest thrust; over the distance from tip to rear adaptor, linear"},
    {"jet_scale", NUMBER(ld_platform, jet_scale, ""), FROM_TO(0, 1000), DEFAULT(1),
     .doc = "factor on that force"},
    {0}};
static const field_block platform_block = {.fields = platform_fields};

// ---- tubes

static const field_row layout_fields[] = {
    {"rows", INTEGER(ld_layout, rows, 1, 100), DEFAULT(1), .doc = "rows, counted along +y"},
    {"columns", INTEGER(ld_layout, columns, 1, 100), DEFAULT(1), .doc = "columns, along +z"},
    {"pitch", NUMBER(ld_layout, pitch, "m"), FROM_TO(0, 100), DEFAULT(0),
     .doc = "distance between neighbours"},
    {"first", VECTOR(ld_layout, first, "m", 3), FROM_TO(-1000, 1000), DEFAULT(0),
     .doc = "rear end of tube 1: platform axes (vehicle) or axes of `tubes.on` (multibody)"},
    {0}};
static const field_block layout_block = {.fields = layout_fields};

static const field_row point_mass_fields[] = {
    {"at", NUMBER(ld_point_mass, at, "m"), FROM_TO(0, 100), REQUIRED, .doc = "station"},
    {"mass", NUMBER(ld_point_mass, mass, "kg"), NOT_NEGATIVE, REQUIRED,
     .doc = "on the axis, without rotary inertia"},
    {0}};
static const field_block point_mass_block = {.fields = point_mass_fields};

static const field_word span_words[] = {{"supported", LD_SPAN_SUPPORTED},
                                        {"clamped", LD_SPAN_CLAMPED},
                                        {"free-free", LD_SPAN_FREE_FREE},
                                        {NULL, 0}};
static const field_word geometric_words[] = {
    {"no", LD_GEOMETRIC_NO}, {"yes", LD_GEOMETRIC_YES}, {NULL, 0}};
static const field_row modes_fields[] = {
    {"bending", INTEGER(ld_modes, bending, 1, LD_MAX_BENDING_MODES), DEFAULT(7),
     .doc = "bending modes a plane"},
    {"torsion", INTEGER(ld_modes, torsion, 0, LD_MAX_TORSION_MODES), DEFAULT(4),
     .doc = "torsion modes"},
    {"axial", INTEGER(ld_modes, axial, 0, LD_MAX_AXIAL_MODES), DEFAULT(0), .doc = "axial modes"},
    {"elements", INTEGER(ld_modes, elements, 2, 400), DEFAULT(60),
     .doc = "least number of finite elements (section steps add nodes)"},
    {"span", CHOICE(ld_modes, span, span_words), DEFAULT(LD_SPAN_SUPPORTED),
     .doc = "boundary conditions of the modes: tube and tail on their springs, clamped at the rear "
            "end, or free"},
    {"damping", NUMBER(ld_modes, damping, ""), FROM_TO(0, 1), DEFAULT(0),
     .doc = "damping ratio of the clamped modes of the bare tube"},
    {"geometric_stiffness", CHOICE(ld_modes, geometric_stiffness, geometric_words),
     DEFAULT(LD_GEOMETRIC_NO),
     .doc = "geometric stiffness: axial forces stiffen or soften bending"},
    {"cut", NUMBER(ld_modes, cut, "Hz"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "faster modes are slowed to this frequency, keeping their static compliance; 0: none"},
    {"shear_coefficient", NUMBER(ld_modes, shear_coefficient, ""), FROM_TO(0, 1), DEFAULT(0),
     .doc = "k of k G A of round sections, about 0.53 of thin tubes, 0.89 of rods; with rotary "
            "inertia. 0: neither shear nor rotary inertia"},
    {0}};
static const field_block modes_block = {.fields = modes_fields};

static const field_row tail_fields[] = {
    {"mass", NUMBER(ld_tail, mass, "kg"), NOT_NEGATIVE, DEFAULT(0), .doc = "mass"},
    {"center", NUMBER(ld_tail, center, "m"), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "x of the mass centre from the tube's rear end; negative: behind"},
    {"inertia", VECTOR(ld_tail, inertia, "kg.m2", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "about its own mass centre, tube axes"},
    {0}};
static const field_block tail_block = {.fields = tail_fields};

static const field_word clamp_words[] = {
    {"x", LD_CLAMP_X},     {"y", LD_CLAMP_Y},         {"z", LD_CLAMP_Z}, {"roll", LD_CLAMP_ROLL},
    {"yaw", LD_CLAMP_YAW}, {"pitch", LD_CLAMP_PITCH}, {NULL, 0}};
static const field_row recoil_fields[] = {
    {"preload", NUMBER(ld_recoil, preload, "N"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "force at which the tube begins to recoil"},
    {"stiffness", NUMBER(ld_recoil, stiffness, "N/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "of the return spring: force over travel"},
    {"damping", NUMBER(ld_recoil, damping, "N.s/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "force over speed"},
    {"quadratic_damping", NUMBER(ld_recoil, quadratic_damping, "N.s2/m2"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "force over the square of the speed"},
    {"friction", NUMBER(ld_recoil, friction, "N"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "Coulomb friction"},
    {"friction_speed", NUMBER(ld_recoil, friction_speed, "m/s"), ABOVE_TO(0, 100), DEFAULT(0.01),
     .doc = "speed at which friction reaches 71 %"},
    {"stroke", NUMBER(ld_recoil, stroke, "m"), ABOVE_TO(0, 100), NO_DEFAULT("no rear stop"),
     .doc = "travel at which the rear stop begins"},
    {0}};
static const field_block recoil_block = {.fields = recoil_fields};
static const field_word recoil_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};

static const field_row support_fields[] = {
    {"at", NUMBER(ld_support, at, "m"), FROM_TO(0, 100), REQUIRED, .doc = "station"},
    {"stiffness", VECTOR(ld_support, stiffness, "N/m", 3), NOT_NEGATIVE,
     NO_DEFAULT("required without clamped directions"), .doc = "along x, y, z of the tube"},
    {"damping", VECTOR(ld_support, damping, "N.s/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "along x, y, z"},
    {"rotational_stiffness", VECTOR(ld_support, rotational_stiffness, "N.m/rad", 3), NOT_NEGATIVE,
     DEFAULT(0), .doc = "about x, y, z"},
    {"rotational_damping", VECTOR(ld_support, rotational_damping, "N.m.s/rad", 3), NOT_NEGATIVE,
     DEFAULT(0), .doc = "about x, y, z"},
    {"clamped", .kind = FIELD_WORDS, .offset = offsetof(ld_support, clamped), .words = clamp_words,
     .initial_doc = "none", .doc = "directions held rigidly, without springs"},
    {"recoil", BLOCK(ld_support, recoil, recoil_block), .initial_doc = "none",
     SWITCH(ld_support, recoil.present, recoil_words), .other_is_bool = true,
     .doc = "slide along x; stiffness and damping along x are then those of its stops"},
    {0}};
static const field_block support_block = {.fields = support_fields};

static const field_row station_fields[] = {
    {"at", NUMBER(ld_station, at, "m"), FROM_TO(0, 100), REQUIRED, .doc = "station"},
    {"outer_fibre", VECTOR(ld_station, outer_fibre, "m", 2), ABOVE_TO(0, 10),
     NO_DEFAULT("outer radius of a section given by radii; else none: no stress"),
     .doc = "outermost corner from the elastic axis, along y and z"},
    {0}};
static const field_block station_block = {.fields = station_fields};

static const field_row slot_columns[] = {
    {"station", .unit = "m", FROM_TO(-100, 100)},
    {"angle", .unit = "rad", INSIDE(-80 * PI / 180, 80 * PI / 180)},
};
static const table_format slot_table = {TABLE_CONSTANT, 2, slot_columns, NULL};
static const field_row slot_fields[] = {
    {"angle", TABLE(ld_slot, angle, slot_table), .required = true,
     .doc = "to the tube's axis in the unrolled tube, constant or over the station (linear, "
            "constant outside)"},
    {"radius", NUMBER(ld_slot, radius, "m"), ABOVE_TO(0, 10), REQUIRED,
     .doc = "of the circle of the knob"},
    {"friction", NUMBER(ld_slot, friction, ""), FROM_TO(0, 10), DEFAULT(0),
     .doc = "Coulomb coefficient between knob and slot"},
    {0}};
static const field_block slot_block = {.fields = slot_fields};
static const field_word slot_words[] = {{"none", LD_SLOT_NONE}, {"", LD_SLOT_HELIX}, {NULL, 0}};

static const field_word pressure_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word pressure_forms[] = {
    {"a pressure over time", LD_PRESSURE_OVER_TIME},
    {"a pressure over travel", LD_PRESSURE_OVER_TRAVEL},
    {"the pressure of a gas that expands", LD_PRESSURE_OF_GAS},
    {NULL, 0}};
static const field_row over_time_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)},
    {"pressure", .unit = "Pa", FROM_TO(0, 1e10)},
};
static const field_row over_travel_columns[] = {
    {"travel", .unit = "m", FROM_TO(0, 100)},
    {"pressure", .unit = "Pa", FROM_TO(0, 1e10)},
};
static const table_format over_time_table = {TABLE_CSV, 2, over_time_columns, NULL};
static const table_format over_travel_table = {TABLE_CSV, 2, over_travel_columns, NULL};
#define OVER_TIME FORM(LD_PRESSURE_OVER_TIME)
#define OVER_TRAVEL FORM(LD_PRESSURE_OVER_TRAVEL)
#define OF_GAS .forms = FORM(LD_PRESSURE_OF_GAS)
static const field_row pressure_fields[] = {
    {"over_time", TABLE(ld_pressure, over_time, over_time_table), .required = true,
     .forms = OVER_TIME,
     .doc = "from ignition, linear, 0 after the last row; a time given twice is a jump"},
    {"over_travel", TABLE(ld_pressure, over_travel, over_travel_table), .required = true,
     .forms = OVER_TRAVEL,
     .doc = "over the travel from rocket.start_at, pchip; rows must reach the tip"},
    {"scale", NUMBER(ld_pressure, scale, ""), FROM_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the pressure, before `ambient` is subtracted"},
    {"pressure", NUMBER(ld_pressure, pressure, "Pa"), ABOVE_TO(0, 1e10), REQUIRED, OF_GAS,
     .doc = "p_0 of cold gas at the start, absolute"},
    {"volume", NUMBER(ld_pressure, volume, "m3"), ABOVE_TO(0, 1e6), REQUIRED, OF_GAS,
     .doc = "V_0 of the gas there, with the bore behind the rocket"},
    {"exponent", NUMBER(ld_pressure, exponent, ""), FROM_TO(0, 10), REQUIRED, OF_GAS,
     .doc = "kappa of p (V_0 + A s')^kappa = p_0 V_0^kappa; adiabatic air: 1.4"},
    {"ambient", NUMBER(ld_pressure, ambient, "Pa"), FROM_TO(0, 1e10), DEFAULT(0),
     .doc = "pressure before the rocket, subtracted"},
    {0}};
static const field_block pressure_block = {.fields = pressure_fields,
                                           .form = pressure_forms,
                                           .form_offset = offsetof(ld_pressure, form),
                                           .form_from_keys = true};

static const field_word shape_words[] = {
    {"flat", LD_SURFACE_FLAT}, {"round", LD_SURFACE_ROUND}, {NULL, 0}};
#define GAP FROM_TO(-0.01, 1)
static const field_row surface_fields[] = {
    {"name", WORD(ld_surface, name), .required = true, .doc = "name in messages and paths"},
    {"at", VECTOR(ld_surface, at, "m", 2), FROM_TO(-10, 10), REQUIRED,
     .doc = "y, z of one of its points from the guide line"},
    {"normal", NUMBER(ld_surface, normal, "rad"), FROM_TO(-2 * PI, 2 * PI), REQUIRED,
     .doc = "direction from the shoe to the surface, from y towards z"},
    {"gap", NUMBER(ld_surface, gap, "m"), GAP, REQUIRED,
     .doc = "to a centred shoe; below 0: pressed by so much"},
    {"shape", CHOICE(ld_surface, shape, shape_words), DEFAULT(LD_SURFACE_FLAT),
     .doc = "flat: roll changes the gap; round: it does not"},
    {0}};
static const field_block surface_block = {.fields = surface_fields};

static const field_row t_slot_fields[] = {
    {"at", VECTOR(ld_t_slot, at, "m", 2), FROM_TO(-10, 10), REQUIRED,
     .doc = "y, z of its middle from the guide line"},
    {"lips", NUMBER(ld_t_slot, lips, "m"), ABOVE_TO(0, 10), REQUIRED,
     .doc = "distance of the lips' middles along z"},
    {"gap", NUMBER(ld_t_slot, gap, "m"), GAP, REQUIRED,
     .doc = "over and under the lips; below 0: pressed by so much"},
    {"side_gap", NUMBER(ld_t_slot, side_gap, "m"), GAP, REQUIRED, .doc = "on either side"},
    {0}};
static const field_block t_slot_block = {.fields = t_slot_fields};

static const field_row tower_fields[] = {
    {"rails", INTEGER(ld_tower, rails, 2, LD_MAX_SURFACES), DEFAULT(4),
     .doc = "number, evenly around the line"},
    {"first", NUMBER(ld_tower, first, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .doc = "direction of the first one, from y towards z"},
    {"gap", NUMBER(ld_tower, gap, "m"), GAP, REQUIRED,
     .doc = "radial, to each rail; below 0: pressed by so much"},
    {"radius", NUMBER(ld_tower, radius, "m"), FROM_TO(0, 10), DEFAULT(0),
     .doc = "of the rails' surfaces, where friction acts"},
    {0}};
static const field_block tower_block = {.fields = tower_fields};

static const field_word guide_forms[] = {{"a guide given by surfaces", LD_GUIDE_SURFACES},
                                         {"a T-slot", LD_GUIDE_T_SLOT},
                                         {"a tower", LD_GUIDE_TOWER},
                                         {NULL, 0}};
static const field_word guide_words[] = {{"bore", 0}, {"", 1}, {NULL, 0}};
static const field_row guide_fields[] = {
    {"line", VECTOR(ld_guide, line, "m", 2), FROM_TO(-10, 10), DEFAULT(0),
     .doc = "y, z of the guide line, from the elastic axis"},
    {"surfaces", LIST(ld_guide, surface, surface_count, surface_block, 1, LD_MAX_SURFACES),
     .required = true, .forms = FORM(LD_GUIDE_SURFACES),
     .doc = "surfaces on which every shoe slides"},
    {"t_slot", BLOCK(ld_guide, t_slot, t_slot_block), .required = true,
     .forms = FORM(LD_GUIDE_T_SLOT), .doc = "six flat surfaces"},
    {"tower", BLOCK(ld_guide, tower, tower_block), .required = true, .forms = FORM(LD_GUIDE_TOWER),
     .doc = "round surfaces around the line"},
    {0}};
static const field_block guide_block = {.fields = guide_fields,
                                        .form = guide_forms,
                                        .form_offset = offsetof(ld_guide, form),
                                        .form_from_keys = true};

static const field_row turned_offset_columns[] = {
    {"station", .unit = "m", FROM_TO(-100, 200)},
    {"y", .unit = "m", FROM_TO(-1, 1)},
    {"z", .unit = "m", FROM_TO(-1, 1)},
    {"twist", .unit = "rad", FROM_TO(-PI / 2, PI / 2)},
};
static const table_format turned_offset_table = {TABLE_CSV, 4, turned_offset_columns, NULL};
static const table_format offset_table = {TABLE_CSV, 3, turned_offset_columns,
                                          &turned_offset_table};
static const field_row random_bends_fields[] = {
    {"deviation", NUMBER(ld_random_bends, deviation, "m"), FROM_TO(0, 1), REQUIRED,
     .doc = "greatest distance from the line between rear end and tip"},
    {"terms", INTEGER(ld_random_bends, terms, 1, 100), DEFAULT(8),
     .doc = "sines of 1 to this many half waves along the tube"},
    {"decay", NUMBER(ld_random_bends, decay, ""), FROM_TO(0, 10), DEFAULT(2),
     .doc = "standard deviations of the sines fall as the number of half waves to this power"},
    {0}};
static const field_block random_bends_block = {.fields = random_bends_fields};
static const field_word random_bends_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row rail_joint_fields[] = {
    {"at", NUMBER(ld_rail_joint, at, "m"), FROM_TO(0, 100), REQUIRED, .doc = "station"},
    {"step", VECTOR(ld_rail_joint, step, "m", 2), FROM_TO(-0.1, 0.1), DEFAULT(0),
     .doc = "y, z: by how much the guide beyond it is off"},
    {"kink", VECTOR(ld_rail_joint, kink, "rad", 2), FROM_TO(-0.1, 0.1), DEFAULT(0),
     .doc = "along y, z: by how much the guide beyond it is turned"},
    {"length", NUMBER(ld_rail_joint, length, "m"), FROM_TO(0.001, 10), REQUIRED,
     .doc = "over which both are rounded, around `at`: length of a shoe or of its chamfer"},
    {0}};
static const field_block rail_joint_block = {.fields = rail_joint_fields};
static const field_row initial_shape_fields[] = {
    {"offsets", TABLE(ld_initial_shape, offsets, offset_table), .initial_doc = "none",
     .doc = "of the guide from a straight line along the tube, over the station (cubic spline); "
            "rows must reach from the rear end to the tip"},
    {"scale", VECTOR(ld_initial_shape, scale, "", 2), FROM_TO(-1000, 1000), DEFAULT(1),
     .doc = "factors on y and on z of `offsets`"},
    {"twist_scale", NUMBER(ld_initial_shape, twist_scale, ""), FROM_TO(-1000, 1000), DEFAULT(1),
     .doc = "factor on their twist"},
    {"accuracy", VECTOR(ld_initial_shape, accuracy, "m", 2), FROM_TO(0, 0.1), DEFAULT(0),
     .doc =
         "standard deviations of y and z of a row; errors are drawn by the seed, before `scale`"},
    {"random", BLOCK(ld_initial_shape, random, random_bends_block), .initial_doc = "none",
     SWITCH(ld_initial_shape, random.present, random_bends_words), .other_is_bool = true,
     .doc = "bends of a given size, y and z independent"},
    {"seed", INTEGER(ld_initial_shape, seed, 0, 999999999), DEFAULT(1),
     .doc = "of `random` and `accuracy`"},
    {"joints", LIST(ld_initial_shape, joint, joint_count, rail_joint_block, 0, LD_MAX_RAIL_JOINTS),
     .initial_doc = "none", .doc = "places where two lengths of the guide meet"},
    {0}};
static const field_block initial_shape_block = {.fields = initial_shape_fields};
static const field_word initial_shape_words[] = {{"straight", 0}, {"", 1}, {NULL, 0}};

static const field_row wind_drag_fields[] = {
    {"from", NUMBER(ld_wind_drag, from, "m"), FROM_TO(0, 100), REQUIRED, .doc = "station"},
    {"to", NUMBER(ld_wind_drag, to, "m"), ABOVE_TO(0, 100), REQUIRED, .doc = "station"},
    {"width", NUMBER(ld_wind_drag, width, "m"), FROM_TO(0, 100), REQUIRED,
     .doc = "across the wind; of a lattice that of its bars together"},
    {"coefficient", NUMBER(ld_wind_drag, coefficient, ""), FROM_TO(0, 100), REQUIRED,
     .doc = "of the drag across the axis, on the width"},
    {0}};
static const field_block wind_drag_block = {.fields = wind_drag_fields};

static const field_row jet_face_fields[] = {{"inner_radius", NUMBER(ld_jet_face, inner, "m"),
                                             FROM_TO(0, 100), DEFAULT(0),
                                             .doc = "of the ring's hole"},
                                            {"outer_radius", NUMBER(ld_jet_face, outer, "m"),
                                             ABOVE_TO(0, 100), REQUIRED, .doc = "of the ring"},
                                            {0}};
static const field_block jet_face_block = {.fields = jet_face_fields};
static const field_word jet_face_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row deflector_fields[] = {
    {"at", NUMBER(ld_deflector, at, "m"), FROM_TO(-100, 100), REQUIRED,
     .doc = "x of its centre from the rear end of tube or rail, behind the nozzle at the start"},
    {"inner_radius", NUMBER(ld_deflector, inner, "m"), FROM_TO(0, 100), DEFAULT(0),
     .doc = "of its hole, seen along the axis"},
    {"outer_radius", NUMBER(ld_deflector, outer, "m"), ABOVE_TO(0, 100), REQUIRED,
     .doc = "seen along the axis"},
    {"push", VECTOR(ld_deflector, push, "", 3), FROM_TO(-2, 2), REQUIRED,
     .doc = "force over that of the jet that hits it, in axes of tube or rail"},
    {0}};
static const field_block deflector_block = {.fields = deflector_fields};

static const field_row tubes_fields[] = {
    {"on", WORD(ld_tubes, on), .initial_doc = "none",
     .doc = "body or beam of a base of kind multibody that carries them; on a beam each support "
            "rides on its own section"},
    {"layout", BLOCK(ld_tubes, layout, layout_block), .initial_doc = "one tube",
     .doc = "where the tubes are"},
    {"empty", INTEGERS(ld_tubes, empty, empty_count, 1, 10000, LD_MAX_TUBES), .initial_doc = "none",
     .doc = "tubes without a rocket from the start"},
    {"length", NUMBER(ld_tubes, length, "m"), ABOVE_TO(0, 100), REQUIRED,
     .doc = "from the rear end to the tip"},
    {"sections", LIST(ld_tubes, section, section_count, section_block, 1, LD_MAX_SECTIONS),
     .required = true, .doc = "lengths of constant section, the first from 0 m"},
    {"point_masses",
     LIST(ld_tubes, point_mass, point_mass_count, point_mass_block, 0, LD_MAX_POINT_MASSES),
     .initial_doc = "none", .doc = "guide rings and other small masses"},
    {"material", BLOCK(ld_tubes, material, material_block), .initial_doc = "none",
     .doc = "for sections given by radii or by area"},
    {"modes", BLOCK(ld_tubes, modes, modes_block), .initial_doc = "as below",
     .doc = "resolution of the tube's deformation"},
    {"tail", BLOCK(ld_tubes, tail, tail_block), .initial_doc = "none",
     .doc = "rigid body welded to the rear end"},
    {"supports", LIST(ld_tubes, support, support_count, support_block, 0, LD_MAX_SUPPORTS),
     .required = true, .doc = "spring-dampers between tube and base"},
    {"loads", LIST(ld_tubes, station, station_count, station_block, 0, LD_MAX_STATIONS),
     .silent = true, .initial_doc = "none",
     .doc = "stations of section loads and stress in the results, and support loads"},
    {"slot", BLOCK(ld_tubes, slot, slot_block), .required = true,
     SWITCH(ld_tubes, slot.kind, slot_words),
     .doc = "slot of the rocket's knob; `none`: smooth bore"},
    {"pressure", BLOCK(ld_tubes, pressure, pressure_block), .initial_doc = "none",
     SWITCH(ld_tubes, pressure.present, pressure_words), .other_is_bool = true,
     .doc = "on the rocket's rear, from ignition to exit, with or without a motor"},
    {"guide", BLOCK(ld_tubes, guide, guide_block), .initial_doc = "bore",
     SWITCH(ld_tubes, guide.present, guide_words), .other_is_bool = true,
     .doc = "guide of the rocket: the bore, or surfaces with the adaptors as shoes"},
    {"initial_shape", BLOCK(ld_tubes, initial_shape, initial_shape_block), .silent = true,
     .initial_doc = "straight", SWITCH(ld_tubes, initial_shape.present, initial_shape_words),
     .other_is_bool = true, .doc = "how the unloaded guide departs from a straight line"},
    {"wind_drag", LIST(ld_tubes, wind_drag, wind_drag_count, wind_drag_block, 0, LD_MAX_WIND_DRAGS),
     .silent = true, .initial_doc = "none",
     .doc = "lengths of the guide that feel `environment.wind`; overlapping ones add up"},
    {"jet", TABLE(ld_tubes, jet, jet_table), .initial_doc = "none",
     .doc =
         "force of the departed rocket's jet on the front end of its tube or rail, backwards, at "
         "greatest thrust; over the distance from tip to rear adaptor, linear"},
    {"jet_scale", NUMBER(ld_tubes, jet_scale, ""), FROM_TO(0, 1000), DEFAULT(1),
     .doc = "factor on that force, and on those of `jet_face` and `deflector`"},
    {"jet_face", BLOCK(ld_tubes, jet_face, jet_face_block), .silent = true, .initial_doc = "none",
     SWITCH(ld_tubes, jet_face.present, jet_face_words), .other_is_bool = true,
     .doc = "instead of `jet`: ring about the tip in the jet of `rocket.motor.plume`"},
    {"deflector", BLOCK(ld_tubes, deflector, deflector_block), .silent = true,
     .initial_doc = "none", SWITCH(ld_tubes, deflector.present, jet_face_words),
     .other_is_bool = true, .doc = "ring behind the rocket in the same jet, from ignition on"},
    {0}};
const field_block tubes_block = {.fields = tubes_fields};

// ---- rocket

static const field_row empty_fields[] = {
    {"mass", NUMBER(ld_mass_data, mass, "kg"), POSITIVE, REQUIRED, .doc = "mass at burn-out"},
    {"center", VECTOR(ld_mass_data, center, "m", 3), FROM_TO(-100, 100), REQUIRED,
     .doc = "mass centre from the rear adaptor"},
    {"inertia", VECTOR(ld_mass_data, inertia, "kg.m2", 3), POSITIVE, REQUIRED,
     .doc = "about the mass centre"},
    {0}};
static const field_block empty_block = {.fields = empty_fields};

static const field_row falling_fields[] = {
    {"mass", NUMBER(ld_falling, mass, "kg"), POSITIVE, REQUIRED, .doc = "part of the rocket's"},
    {"center", VECTOR(ld_falling, center, "m", 2), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "y, z of its mass centre from the rocket's axis; x is the adaptor's"},
    {"inertia", VECTOR(ld_falling, inertia, "kg.m2", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "about its own mass centre"},
    {0}};
static const field_block falling_block = {.fields = falling_fields};
static const field_word falling_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row adaptor_fields[] = {
    {"name", WORD(ld_adaptor, name), .required = true, .doc = "name in results and paths"},
    {"at", NUMBER(ld_adaptor, at, "m"), FROM_TO(0, 100), REQUIRED,
     .doc = "x of its centre from the rear adaptor"},
    {"clearance", NUMBER(ld_adaptor, clearance, "m"), FROM_TO(0, 10),
     NO_DEFAULT("required in a bore except with `bilateral`, `ideal`"),
     .doc = "radial: rear inner radius of the tube less radius of the adaptor, > 0; on surfaces: "
            "added to each gap of this shoe"},
    {"leaves_at", NUMBER(ld_adaptor, leaves_at, "m"), ABOVE_TO(0, 100), NO_DEFAULT("tubes.length"),
     .doc = "station of the guide at which its contact ends, at most the tip's; the rear adaptor "
            "leaves last, or with others"},
    {"falls_off", BLOCK(ld_adaptor, falls_off, falling_block), .initial_doc = "none",
     SWITCH(ld_adaptor, falls_off.present, falling_words), .other_is_bool = true, .silent = true,
     .doc = "part of the rocket that falls off with the adaptor as this leaves the guide"},
    {0}};
static const field_block adaptor_block = {.fields = adaptor_fields};

#define LAW_WORD(name, word, traits) {word, name},
static const field_word law_words[] = {LD_CONTACT_LAWS(LAW_WORD){NULL, 0}};
static const field_row drag_columns[] = {
    {"travel", .unit = "m", FROM_TO(0, 100)},
    {"drag", .unit = "N", FROM_TO(0, 1e9)},
};
static const table_format drag_table = {TABLE_CONSTANT, 2, drag_columns, NULL};
static const field_row speed_drag_columns[] = {
    {"speed", .unit = "m/s", FROM_TO(0, 1e4)},
    {"drag", .unit = "N", FROM_TO(0, 1e9)},
};
static const table_format speed_drag_table = {TABLE_CSV, 2, speed_drag_columns, NULL};
static const field_row contact_fields[] = {
    {"law", CHOICE(ld_contact, law, law_words), DEFAULT(0),
     .doc = "force over penetration; on the axis by springs (bilateral) or exactly (ideal)"},
    {"stiffness", NUMBER(ld_contact, stiffness, "N/m"), POSITIVE,
     NO_DEFAULT("required except with `ideal`"),
     .doc = "k, in N/m for every exponent; with ideal of the breech only"},
    {"exponent", NUMBER(ld_contact, exponent, ""), FROM_TO(1, 5), DEFAULT(1),
     .doc = "n of k d_0 (p/d_0)^n; 1 for kelvin-voigt, bilateral"},
    {"reference_penetration", NUMBER(ld_contact, reference_penetration, "m"), ABOVE_TO(0, 1),
     DEFAULT(1e-3), .doc = "d_0"},
    {"restitution", NUMBER(ld_contact, restitution, ""), FROM_TO(0, 1), DEFAULT(1),
     .doc = "e (hunt-crossley, lankarani-nikravesh)"},
    {"reference_speed", NUMBER(ld_contact, reference_speed, "m/s"), ABOVE_TO(0, 1000), DEFAULT(0.5),
     .doc = "v_0, speed of the contact for which restitution holds (hunt-crossley)"},
    {"damping", NUMBER(ld_contact, damping, "N.s/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "c (kelvin-voigt, bilateral)"},
    {"friction", NUMBER(ld_contact, friction, ""), FROM_TO(0, 10), DEFAULT(0),
     .doc = "Coulomb coefficient (except bilateral, ideal)"},
    {"friction_speed", NUMBER(ld_contact, friction_speed, "m/s"), ABOVE_TO(0, 100), DEFAULT(0.01),
     .doc = "v_eps, speed at which friction reaches 71 %, in contact and slot"},
    {"drag", TABLE(ld_contact, drag, drag_table), .initial_doc = "0",
     .doc =
         "force of the guide against sliding, constant or over the travel from start_at (linear, "
         "constant outside); each adaptor in the guide takes an equal share"},
    {"drag_over_speed", TABLE(ld_contact, drag_over_speed, speed_drag_table), .initial_doc = "0",
     .doc = "added to `drag`, over the sliding speed of each adaptor, of either sign (linear, "
            "constant outside)"},
    {"drag_scale", NUMBER(ld_contact, drag_scale, ""), FROM_TO(0, 1000), DEFAULT(1),
     .doc = "factor on `drag` and `drag_over_speed`"},
    {0}};
static const field_block contact_block = {.fields = contact_fields};

static const field_row knob_fields[] = {{"angle", NUMBER(ld_rocket, knob_angle, "rad"),
                                         FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
                                         .doc = "of the knob from y of B, about x"},
                                        {0}};
static const field_block knob_block = {.fields = knob_fields};

static const field_row lock_at_fields[] = {
    {"x", NUMBER(ld_lock, x, "m"), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "along the axis, from the rear adaptor"},
    {"radius", NUMBER(ld_lock, radius, "m"), FROM_TO(0, 100), DEFAULT(0), .doc = "from the axis"},
    {"angle", NUMBER(ld_lock, angle, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .doc = "from y of B, about x"},
    {0}};
static const field_block lock_at_block = {.fields = lock_at_fields};

static const field_word hold_words[] = {
    {"by-guide", LD_HOLD_BY_GUIDE}, {"yes", LD_HOLD_YES}, {"no", LD_HOLD_NO}, {NULL, 0}};
static const field_row lock_fields[] = {
    {"release_force", NUMBER(ld_lock, release_force, "N"), POSITIVE, REQUIRED,
     .doc = "carried force at which the lock releases"},
    {"hold_down", NUMBER(ld_lock, hold_down, "s"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "time from ignition before which it never releases"},
    {"at", SAME_STRUCT(lock_at_block), .initial_doc = "the rear adaptor's centre",
     .doc = "point of the rocket that the lock holds"},
    {"holds_roll", CHOICE(ld_lock, holds_roll, hold_words), DEFAULT(LD_HOLD_BY_GUIDE),
     .doc = "whether the lock holds the roll; `by-guide`: without slot and flat surfaces"},
    {0}};
static const field_block lock_block = {.fields = lock_fields};
static const field_word lock_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};

static const field_row thrust_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)},
    {"thrust", .unit = "N", ANY},
};
static const table_format thrust_table = {TABLE_ENGINE | TABLE_ROCKSIM, 2, thrust_columns, NULL};
static const field_row masses_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)},     {"mass", .unit = "kg", NOT_NEGATIVE},
    {"center", .unit = "m", FROM_TO(-100, 100)},  {"inertia_x", .unit = "kg.m2", NOT_NEGATIVE},
    {"inertia_y", .unit = "kg.m2", NOT_NEGATIVE},
};
static const table_format masses_table = {TABLE_CSV | TABLE_ROCKSIM, 5, masses_columns, NULL};
static const field_row side_force_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)},
    {"y", .unit = "N", FROM_TO(-1e9, 1e9)},
    {"z", .unit = "N", FROM_TO(-1e9, 1e9)},
};
static const table_format side_force_table = {TABLE_CSV, 3, side_force_columns, NULL};
static const field_row nozzle_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)}, {"eps_y", .unit = "rad", FROM_TO(-1, 1)},
    {"eps_z", .unit = "rad", FROM_TO(-1, 1)}, {"y", .unit = "m", FROM_TO(-100, 100)},
    {"z", .unit = "m", FROM_TO(-100, 100)},
};
static const table_format nozzle_table = {TABLE_CSV, 5, nozzle_columns, NULL};
static const field_row deviation_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)},
    {"deviation", .unit = "N", FROM_TO(0, 1e9)},
};
static const table_format deviation_table = {TABLE_CONSTANT, 2, deviation_columns, NULL};
static const field_row spectrum_columns[] = {
    {"frequency", .unit = "Hz", FROM_TO(0, 1e5)},
    {"density", .unit = "", NOT_NEGATIVE},
};
static const table_format spectrum_table = {TABLE_CSV, 2, spectrum_columns, NULL};
static const field_word noise_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word spectrum_forms[] = {
    {"a corner frequency", LD_SPECTRUM_CORNER}, {"a spectrum", LD_SPECTRUM_TABLE}, {NULL, 0}};
static const field_row side_noise_fields[] = {
    {"deviation", TABLE(ld_side_noise, deviation, deviation_table), .required = true,
     .doc = "standard deviation of F_y and of F_z, constant or over time from ignition (linear, "
            "constant outside)"},
    {"corner", NUMBER(ld_side_noise, corner, "Hz"), ABOVE_TO(0, 1e4), REQUIRED,
     .forms = FORM(LD_SPECTRUM_CORNER),
     .doc = "f_c of the power spectrum 1/(1 + (f/f_c)^2), cut off at 10 f_c"},
    {"spectrum", TABLE(ld_side_noise, spectrum, spectrum_table), .required = true,
     .forms = FORM(LD_SPECTRUM_TABLE),
     .doc = "power density over the frequency, linear, 0 outside; its shape counts"},
    {"seed", INTEGER(ld_side_noise, seed, 0, 999999999), DEFAULT(1),
     .doc = "of phases and frequencies"},
    {"harmonics", INTEGER(ld_side_noise, harmonics, 1, 1000), DEFAULT(100),
     .doc = "cells of the spectrum"},
    {0}};
static const field_block side_noise_block = {.fields = side_noise_fields,
                                             .form = spectrum_forms,
                                             .form_offset = offsetof(ld_side_noise, form),
                                             .form_from_keys = true};
static const field_row side_force_fields[] = {
    {"force", TABLE(ld_side_force, force, side_force_table), .initial_doc = "0",
     .doc = "F_y, F_z in B over time from ignition, linear, constant outside"},
    {"scale", NUMBER(ld_side_force, scale, ""), FROM_TO(-1000, 1000), DEFAULT(1),
     .doc = "factor on `force` and `fluctuation.deviation`"},
    {"angle", NUMBER(ld_side_force, angle, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .doc = "turns `force` about x of B, from y towards z"},
    {"fluctuation", BLOCK(ld_side_force, noise, side_noise_block), .initial_doc = "none",
     SWITCH(ld_side_force, noise.present, noise_words), .other_is_bool = true,
     .doc = "random part, F_y and F_z independent"},
    {0}};
static const field_block side_force_block = {.fields = side_force_fields};
static const field_word side_force_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row plume_columns[] = {
    {"distance", .unit = "m", FROM_TO(0, 1000)},
    {"radius", .unit = "m", FROM_TO(0, 100)},
    {"pressure", .unit = "Pa", NOT_NEGATIVE},
};
static const table_format plume_table = {TABLE_CSV | TABLE_GROUPS, 3, plume_columns, NULL};
static const field_word plume_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word plume_forms[] = {
    {"a width", LD_PLUME_ROUND}, {"pressures", LD_PLUME_TABLE}, {NULL, 0}};
static const field_row plume_fields[] = {
    {"radius", NUMBER(ld_plume, radius, "m"), ABOVE_TO(0, 100), REQUIRED,
     .forms = FORM(LD_PLUME_ROUND),
     .doc = "of the jet at the nozzle, where its pressure is 1/e of that on its axis"},
    {"spread", NUMBER(ld_plume, spread, ""), FROM_TO(0, 1), REQUIRED, .forms = FORM(LD_PLUME_ROUND),
     .doc = "growth of that radius over the distance"},
    {"pressure", TABLE(ld_plume, pressure, plume_table), .required = true,
     .forms = FORM(LD_PLUME_TABLE),
     .doc = "at greatest thrust, over distance behind the nozzle and radius; linear in both"},
    {"ends_at", NUMBER(ld_plume, reach, "m"), ABOVE_TO(0, 1000), REQUIRED,
     .doc = "distance; over its last tenth the jet fades"},
    {0}};
static const field_block plume_block = {.fields = plume_fields,
                                        .form = plume_forms,
                                        .form_offset = offsetof(ld_plume, form),
                                        .form_from_keys = true};
static const field_word jet_damping_words[] = {
    {"no", LD_JET_DAMPING_NO}, {"yes", LD_JET_DAMPING_YES}, {NULL, 0}};
static const field_row motor_fields[] = {
    {"thrust", TABLE(ld_motor, thrust, thrust_table), .required = true,
     .doc = "over time from ignition, linear, 0 after the last row; a time given twice is a jump; "
            "values below 0 count as 0"},
    {"at", VECTOR(ld_motor, at, "m", 3), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "point of action in B"},
    {"misalignment", VECTOR(ld_motor, misalignment, "rad", 2), FROM_TO(-1, 1), DEFAULT(0),
     .doc = "eps_y, eps_z: thrust along (1, eps_y, eps_z) of B"},
    {"thrust_scale", NUMBER(ld_motor, thrust_scale, ""), ABOVE_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the thrust"},
    {"time_scale", NUMBER(ld_motor, time_scale, ""), ABOVE_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the times of the tables"},
    {"rise_scale", NUMBER(ld_motor, rise_scale, ""), ABOVE_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the times up to the first row of `thrust` at 90 % of the greatest; what "
            "follows moves along"},
    {"delay", NUMBER(ld_motor, delay, "s"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "from ignition to the beginning of the motor's tables"},
    {"jet_damping", CHOICE(ld_motor, jet_damping, jet_damping_words), DEFAULT(LD_JET_DAMPING_NO),
     .doc = "in free flight: jet damping and rates of mass, centre and inertia"},
    {"exit_radius", NUMBER(ld_motor, exit_radius, "m"), FROM_TO(0, 100), DEFAULT(0),
     .doc = "of the nozzle, for jet damping"},
    {"masses", TABLE(ld_motor, masses, masses_table), .initial_doc = "none",
     .doc =
         "over time from ignition, linear, of the part that loses mass: propellant, tanks, motor "
         "or all; inertia about its own centre; in place of rocket.empty and rocket.propellant"},
    {"masses_at", NUMBER(ld_motor, masses_at, "m"), FROM_TO(-100, 100), DEFAULT(0),
     .doc =
         "x of B from which the centres of `masses` count; for an .rse file the motor's front end"},
    {"side_force", BLOCK(ld_motor, side_force, side_force_block), .initial_doc = "none",
     SWITCH(ld_motor, side_force.present, side_force_words), .other_is_bool = true,
     .doc = "across the axis at `at`, while the motor burns"},
    {"nozzle", TABLE(ld_motor, nozzle, nozzle_table), .initial_doc = "none",
     .doc = "moves over time from ignition, added to `misalignment` and `at`; linear, constant "
            "outside"},
    {"plume", BLOCK(ld_motor, plume, plume_block), .silent = true, .initial_doc = "none",
     SWITCH(ld_motor, plume.present, plume_words), .other_is_bool = true,
     .doc = "jet of all motors on `tubes.jet_face` and `tubes.deflector`"},
    {0}};
static const field_block motor_block = {.fields = motor_fields};
static const field_row further_motor_fields[] = {
    {"thrust", TABLE(ld_further_motor, thrust, thrust_table), .required = true,
     .doc = "as of rocket.motor, as what follows"},
    {"at", VECTOR(ld_further_motor, at, "m", 3), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "point of action in B"},
    {"misalignment", VECTOR(ld_further_motor, misalignment, "rad", 2), FROM_TO(-1, 1), DEFAULT(0),
     .doc = "eps_y, eps_z: thrust along (1, eps_y, eps_z) of B"},
    {"thrust_scale", NUMBER(ld_further_motor, thrust_scale, ""), ABOVE_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the thrust"},
    {"time_scale", NUMBER(ld_further_motor, time_scale, ""), ABOVE_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the times of the tables"},
    {"delay", NUMBER(ld_further_motor, delay, "s"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "from ignition to the beginning of the motor's tables"},
    {"masses", TABLE(ld_further_motor, masses, masses_table), .initial_doc = "none",
     .doc = "of a part on the line through `at` along x; only with rocket.motor.masses"},
    {"masses_at", NUMBER(ld_further_motor, masses_at, "m"), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "x of B from which the centres of `masses` count"},
    {0}};
static const field_block further_motor_block = {.fields = further_motor_fields};

static const field_word aerodynamics_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word aerodynamics_models[] = {{"table", LD_AERODYNAMICS_TABLE},
                                                 {"body", LD_AERODYNAMICS_BODY},
                                                 {"surfaces", LD_AERODYNAMICS_SURFACES},
                                                 {NULL, 0}};
static const field_word interpolation_words[] = {
    {"pchip", LD_PCHIP}, {"spline", LD_SPLINE}, {"linear", LD_LINEAR}, {NULL, 0}};
static const field_word beyond_words[] = {
    {"error", LD_BEYOND_ERROR}, {"hold", LD_BEYOND_HOLD}, {NULL, 0}};
static const field_word crossflow_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row coefficient_columns[] = {
    {"mach", .unit = "", FROM_TO(0, 100)},
    {"ca_power_off", .unit = "", NOT_NEGATIVE},
    {"ca_power_on", .unit = "", NOT_NEGATIVE},
    {"cn_alpha", .unit = "", NOT_NEGATIVE},
    {"x_cp", .unit = "m", FROM_TO(-1000, 1000)},
    {"cl_delta", .unit = "", ANY},
    {"cl_p", .unit = "", .range = {-INFINITY, 0, 1, 0}},
    {"cm_q", .unit = "", .range = {-INFINITY, 0, 1, 0}},
};
static const table_format coefficient_table = {TABLE_CSV | TABLE_BARE, 8, coefficient_columns,
                                               NULL};
static const field_row crossflow_fields[] = {
    {"drag", NUMBER(ld_aerodynamics, crossflow.drag, ""), NOT_NEGATIVE, REQUIRED,
     .doc = "drag coefficient of the lateral speed, on the reference area"},
    {"at", NUMBER(ld_aerodynamics, crossflow.at, "m"), FROM_TO(-100, 100), REQUIRED,
     .doc = "x of its point of action in B"},
    {0}};
static const field_block crossflow_block = {.fields = crossflow_fields};
static const field_word emerged_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row emerged_fields[] = {
    {"nose", NUMBER(ld_aerodynamics, emerged.nose, "m"), ABOVE_TO(0, 100), REQUIRED,
     .doc = "x of the nose in B; from the tube's tip to it the rocket is in the air"},
    {"drag", NUMBER(ld_aerodynamics, emerged.drag, ""), FROM_TO(0, 100), REQUIRED,
     .doc = "C_c, drag coefficient of the lateral speed, on diameter times length"},
    {"diameter", NUMBER(ld_aerodynamics, emerged.diameter, "m"), ABOVE_TO(0, 100),
     NO_DEFAULT("reference_diameter; required by a plain body"), .doc = "D"},
    {0}};
static const field_block emerged_block = {.fields = emerged_fields};
// ---- the air by surface

static const field_row axial_column[] = {
    {"mach", .unit = "", FROM_TO(0, 100)},
    {"ca", .unit = "", NOT_NEGATIVE},
};
static const field_row axial_columns[] = {
    {"mach", .unit = "", FROM_TO(0, 100)},
    {"ca_power_off", .unit = "", NOT_NEGATIVE},
    {"ca_power_on", .unit = "", NOT_NEGATIVE},
};
static const table_format axial_pair = {TABLE_CSV | TABLE_BARE, 3, axial_columns, NULL};
static const table_format axial_table = {TABLE_CONSTANT | TABLE_CSV | TABLE_BARE, 2, axial_column,
                                         &axial_pair};
static const field_row slope_columns[] = {
    {"mach", .unit = "", FROM_TO(0, 100)},
    {"cn_alpha", .unit = "", ANY},
};
static const table_format slope_table = {TABLE_CONSTANT | TABLE_CSV | TABLE_BARE, 2, slope_columns,
                                         NULL};
static const field_row forcing_columns[] = {
    {"mach", .unit = "", FROM_TO(0, 100)},
    {"cl_delta", .unit = "", ANY},
};
static const table_format forcing_table = {TABLE_CONSTANT | TABLE_CSV | TABLE_BARE, 2,
                                           forcing_columns, NULL};
static const field_row roll_damping_columns[] = {
    {"mach", .unit = "", FROM_TO(0, 100)},
    {"cl_p", .unit = "", .range = {-INFINITY, 0, 1, 0}},
};
static const table_format roll_damping_table = {TABLE_CONSTANT | TABLE_CSV | TABLE_BARE, 2,
                                                roll_damping_columns, NULL};
static const field_word air_surface_kinds[] = {{"coefficients", LD_AIR_COEFFICIENTS},
                                               {"nose", LD_AIR_NOSE},
                                               {"body", LD_AIR_BODY},
                                               {"tail", LD_AIR_TAIL},
                                               {"fins", LD_AIR_FINS},
                                               {NULL, 0}};
static const field_word nose_shapes[] = {{"cone", LD_NOSE_CONE},
                                         {"ogive", LD_NOSE_OGIVE},
                                         {"von-karman", LD_NOSE_VON_KARMAN},
                                         {"haack", LD_NOSE_HAACK},
                                         {"ellipsoid", LD_NOSE_ELLIPSOID},
                                         {"paraboloid", LD_NOSE_PARABOLOID},
                                         {NULL, 0}};
#define COEFFICIENTS FORM(LD_AIR_COEFFICIENTS)
#define NOSE FORM(LD_AIR_NOSE)
#define CYLINDER FORM(LD_AIR_BODY)
#define TAIL FORM(LD_AIR_TAIL)
#define FINS FORM(LD_AIR_FINS)
#define LENGTH ABOVE_TO(0, 100)
static const field_row air_surface_fields[] = {
    {"name", WORD(ld_air_surface, name), .required = true, .doc = "name in paths"},
    {"kind", CHOICE(ld_air_surface, kind, air_surface_kinds), DEFAULT(LD_AIR_COEFFICIENTS),
     .doc = "by coefficients, or by a shape (Barrowman's formulas)"},
    {"at", NUMBER(ld_air_surface, at, "m"), FROM_TO(-100, 100), REQUIRED,
     .doc = "x in B: with coefficients point of action, with a shape its front end (fins: of the "
            "root chord)"},
    {"slope", TABLE(ld_air_surface, slope, slope_table), .required = true, .forms = COEFFICIENTS,
     .doc = "of the lateral force, per radian"},
    {"area", NUMBER(ld_air_surface, area, "m2"), POSITIVE, NO_DEFAULT("pi d^2/4"),
     .forms = COEFFICIENTS, .doc = "reference area of the coefficients"},
    {"roll_forcing", TABLE(ld_air_surface, roll_forcing, forcing_table), .initial_doc = "0",
     .forms = COEFFICIENTS, .doc = "moment about x per radian of cant, length d"},
    {"roll_damping", TABLE(ld_air_surface, roll_damping, roll_damping_table), .initial_doc = "0",
     .forms = COEFFICIENTS, .doc = "moment about x for rates times d/(2 V), length d"},
    {"shape", CHOICE(ld_air_surface, shape, nose_shapes), .required = true, .forms = NOSE,
     .doc = "tangent ogive; haack: least drag for length and volume"},
    {"length", NUMBER(ld_air_surface, length, "m"), LENGTH, REQUIRED,
     .forms = NOSE | CYLINDER | TAIL, .doc = "along the axis"},
    {"radius", NUMBER(ld_air_surface, radius, "m"), LENGTH, REQUIRED,
     .forms = NOSE | CYLINDER | FINS, .doc = "of the nose's base, the body, the body under fins"},
    {"front_radius", NUMBER(ld_air_surface, front_radius, "m"), FROM_TO(0, 100), REQUIRED,
     .forms = TAIL, .doc = "at the front end"},
    {"rear_radius", NUMBER(ld_air_surface, rear_radius, "m"), FROM_TO(0, 100), REQUIRED,
     .forms = TAIL, .doc = "at the rear end"},
    {"body_lift", NUMBER(ld_air_surface, body_lift, ""), FROM_TO(0, 100), DEFAULT(0),
     .forms = NOSE | CYLINDER | TAIL,
     .doc = "K of the lateral force K times side area times dynamic pressure of the lateral speed; "
            "usually 1.1 to 1.5"},
    {"fin_count", INTEGER(ld_air_surface, count, 3, 8), REQUIRED, .forms = FINS,
     .doc = "number, evenly around the body"},
    {"root_chord", NUMBER(ld_air_surface, root_chord, "m"), LENGTH, REQUIRED, .forms = FINS,
     .doc = "along the body"},
    {"tip_chord", NUMBER(ld_air_surface, tip_chord, "m"), FROM_TO(0, 100), REQUIRED, .forms = FINS,
     .doc = "at the outer end"},
    {"span", NUMBER(ld_air_surface, span, "m"), LENGTH, REQUIRED, .forms = FINS,
     .doc = "of one fin, from the body's surface"},
    {"sweep_length", NUMBER(ld_air_surface, sweep_length, "m"), FROM_TO(-100, 100), DEFAULT(0),
     .forms = FINS, .doc = "of the tip's leading edge behind the root's"},
    {"cant", NUMBER(ld_air_surface, cant, "rad"), FROM_TO(-PI / 2, PI / 2), DEFAULT(0),
     .forms = COEFFICIENTS | FINS, .doc = "positive spins about +x"},
    {"slope_scale", NUMBER(ld_air_surface, slope_scale, ""), FROM_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the slope"},
    {0}};
static const field_block air_surface_block = {.fields = air_surface_fields,
                                              .form = air_surface_kinds,
                                              .form_offset = offsetof(ld_air_surface, kind),
                                              .form_key = "kind"};

#define TABLED .forms = FORM(LD_AERODYNAMICS_TABLE)
#define BY_SURFACE .forms = FORM(LD_AERODYNAMICS_SURFACES)
#define OVER_MACH .forms = FORM(LD_AERODYNAMICS_TABLE) | FORM(LD_AERODYNAMICS_SURFACES)
#define PLAIN_BODY .forms = FORM(LD_AERODYNAMICS_BODY)
static const field_row aerodynamics_fields[] = {
    {"model", CHOICE(ld_aerodynamics, model, aerodynamics_models), DEFAULT(LD_AERODYNAMICS_TABLE),
     .doc = "coefficients over the Mach number (table), by surface, or a body with drag and "
            "damping at its mass centre"},
    {"reference_diameter", NUMBER(ld_aerodynamics, reference_diameter, "m"), ABOVE_TO(0, 100),
     REQUIRED, OVER_MACH, .doc = "d, the reference length; reference area pi d^2/4"},
    {"fin_cant", NUMBER(ld_aerodynamics, fin_cant, "rad"), FROM_TO(-PI / 2, PI / 2), DEFAULT(0),
     TABLED, .doc = "positive spins about +x"},
    {"interpolation", CHOICE(ld_aerodynamics, interpolation, interpolation_words),
     DEFAULT(LD_PCHIP), OVER_MACH, .doc = "between rows over the Mach number"},
    {"beyond_table", CHOICE(ld_aerodynamics, beyond_table, beyond_words), DEFAULT(LD_BEYOND_ERROR),
     OVER_MACH, .doc = "past the last Mach number (fins by shape: 10): stop, or hold its values"},
    {"table", TABLE(ld_aerodynamics, table, coefficient_table), .required = true, TABLED,
     .doc = "cn_alpha and cl_delta per radian, x_cp forward of the rear adaptor, cl_p and cm_q for "
            "rates times d/(2 V)"},
    {"crossflow", SAME_STRUCT(crossflow_block), .initial_doc = "none", OVER_MACH,
     SWITCH(ld_aerodynamics, crossflow.present, crossflow_words), .other_is_bool = true,
     .doc = "drag at large angles of attack"},
    {"emerged", SAME_STRUCT(emerged_block), .initial_doc = "none",
     SWITCH(ld_aerodynamics, emerged.present, emerged_words), .other_is_bool = true,
     .doc = "drag of the lateral speed on the emerged part, until the exit"},
    {"ca_scale", NUMBER(ld_aerodynamics, ca_scale, ""), FROM_TO(0, 1000), DEFAULT(1), OVER_MACH,
     .doc = "factor on ca_power_off and ca_power_on"},
    {"cn_scale", NUMBER(ld_aerodynamics, cn_scale, ""), FROM_TO(0, 1000), DEFAULT(1), OVER_MACH,
     .doc = "factor on cn_alpha or every slope"},
    {"x_cp_shift", NUMBER(ld_aerodynamics, x_cp_shift, "m"), FROM_TO(-100, 100), DEFAULT(0),
     OVER_MACH, .doc = "added to x_cp or every position"},
    {"area", NUMBER(ld_aerodynamics, area, "m2"), NOT_NEGATIVE, REQUIRED, PLAIN_BODY,
     .doc = "reference area"},
    {"drag", NUMBER(ld_aerodynamics, drag, ""), NOT_NEGATIVE, DEFAULT(0), PLAIN_BODY,
     .doc = "coefficient in every direction"},
    {"damping", VECTOR(ld_aerodynamics, damping, "", 3), ANY, DEFAULT(0), PLAIN_BODY,
     .doc = "moment coefficients of the rates about x, y, z times l_i/(2 V)"},
    {"lengths", VECTOR(ld_aerodynamics, lengths, "m", 3), NOT_NEGATIVE, DEFAULT(0), PLAIN_BODY,
     .doc = "l_i, reference lengths of the damping about x, y, z"},
    {"axial", TABLE(ld_aerodynamics, axial, axial_table), .required = true, BY_SURFACE,
     .doc =
         "of the axial force, on the reference area; with three columns one while the motor burns"},
    {"surfaces",
     LIST(ld_aerodynamics, surface, surface_count, air_surface_block, 1, LD_MAX_AIR_SURFACES),
     .required = true, BY_SURFACE, .doc = "surfaces with lateral force"},
    {0}};
static const field_block aerodynamics_block = {.fields = aerodynamics_fields,
                                               .form = aerodynamics_models,
                                               .form_offset = offsetof(ld_aerodynamics, model),
                                               .form_key = "model"};

static const field_word trigger_words[] = {{"apogee", LD_TRIGGER_APOGEE},
                                           {"time", LD_TRIGGER_TIME},
                                           {"height", LD_TRIGGER_HEIGHT},
                                           {NULL, 0}};
static const field_word canopy_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row canopy_fields[] = {
    {"mass", NUMBER(ld_canopy, mass, "kg"), POSITIVE, REQUIRED,
     .doc = "of the canopy, part of the rocket's mass (at `at`) until it opens"},
    {"line_length", NUMBER(ld_canopy, line_length, "m"), ABOVE_TO(0, 1000), REQUIRED,
     .doc = "from the rocket to the canopy, unstretched"},
    {"line_stiffness", NUMBER(ld_canopy, line_stiffness, "N"), ABOVE_TO(0, 1e9), REQUIRED,
     .doc = "EA of all lines together: tension over strain"},
    {"damping", NUMBER(ld_canopy, damping, ""), FROM_TO(0, 1), DEFAULT(0.1),
     .doc = "of the canopy's motion against the rocket, of the critical one"},
    {"at", VECTOR(ld_canopy, at, "m", 3), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "point of the rocket to which the lines are attached, in B"},
    {"ejection", VECTOR(ld_canopy, ejection, "m/s", 3), FROM_TO(-1000, 1000), DEFAULT(0),
     .doc = "velocity against that point with which it leaves, in B"},
    {"packed_area", NUMBER(ld_canopy, packed_area, "m2"), FROM_TO(0, 1e5), DEFAULT(0),
     .doc = "drag area until the lines are taut; from then on it fills"},
    {"air_volume", NUMBER(ld_canopy, air_volume, "m3"), FROM_TO(0, 1e7), DEFAULT(0),
     .doc = "of air that moves with the full canopy: added mass over density"},
    {"strength", NUMBER(ld_canopy, strength, "N"), POSITIVE, NO_DEFAULT("not checked"),
     .doc = "of the lines: a greater force gives a warning"},
    {0}};
static const field_block canopy_block = {.fields = canopy_fields};
static const field_row parachute_fields[] = {
    {"name", WORD(ld_parachute, name), .required = true, .doc = "name in results and paths"},
    {"drag_area", NUMBER(ld_parachute, drag_area, "m2"), ABOVE_TO(0, 1e5), REQUIRED,
     .doc = "drag coefficient times area when full, with its load"},
    {"trigger", CHOICE(ld_parachute, trigger, trigger_words), .required = true,
     .doc = "apogee, time from ignition, or height above ground on the descent"},
    {"time", NUMBER(ld_parachute, time, "s"), FROM_TO(0, 10000), REQUIRED,
     .forms = FORM(LD_TRIGGER_TIME), .doc = "from ignition"},
    {"height", NUMBER(ld_parachute, height, "m"), FROM_TO(0, 1e6), REQUIRED,
     .forms = FORM(LD_TRIGGER_HEIGHT), .doc = "of the mass centre above the ground"},
    {"lag", NUMBER(ld_parachute, lag, "s"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "from the trigger to the opening"},
    {"filling", NUMBER(ld_parachute, filling, "s"), FROM_TO(0, 100), DEFAULT(0),
     .doc = "duration of the change from the previous drag area"},
    {"filling_distance", NUMBER(ld_parachute, filling_distance, "m"), ABOVE_TO(0, 10000),
     NO_DEFAULT("by `filling`"),
     .doc = "way through the air in which it changes, instead of a duration"},
    {"filling_power", NUMBER(ld_parachute, filling_power, ""), FROM_TO(1, 10), DEFAULT(1),
     .doc = "of the share of that time or way by which it changes; 1: linear"},
    {"canopy", BLOCK(ld_parachute, canopy, canopy_block), .initial_doc = "none",
     SWITCH(ld_parachute, canopy.present, canopy_words), .other_is_bool = true,
     .doc = "a body of its own on lines, below which the rocket swings"},
    {0}};
static const field_block parachute_block = {.fields = parachute_fields,
                                            .form = trigger_words,
                                            .form_offset = offsetof(ld_parachute, trigger),
                                            .form_key = "trigger"};

static const field_word brakes_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word brakes_forms[] = {{"brakes over time", LD_BRAKES_OVER_TIME},
                                          {"brakes over height", LD_BRAKES_OVER_HEIGHT},
                                          {NULL, 0}};
static const field_row brakes_time_columns[] = {
    {"time", .unit = "s", FROM_TO(0, 10000)},
    {"drag_area", .unit = "m2", FROM_TO(0, 1e5)},
};
static const field_row brakes_height_columns[] = {
    {"height", .unit = "m", FROM_TO(-1e6, 1e6)},
    {"drag_area", .unit = "m2", FROM_TO(0, 1e5)},
};
static const table_format brakes_time_table = {TABLE_CSV, 2, brakes_time_columns, NULL};
static const table_format brakes_height_table = {TABLE_CSV, 2, brakes_height_columns, NULL};
static const field_row air_brakes_fields[] = {
    {"over_time", TABLE(ld_air_brakes, over_time, brakes_time_table), .required = true,
     .forms = FORM(LD_BRAKES_OVER_TIME),
     .doc = "drag coefficient times area over the time from ignition, linear, constant outside"},
    {"over_height", TABLE(ld_air_brakes, over_height, brakes_height_table), .required = true,
     .forms = FORM(LD_BRAKES_OVER_HEIGHT),
     .doc = "the same over the mass centre's height above ground"},
    {"scale", NUMBER(ld_air_brakes, scale, ""), FROM_TO(0, 1000), DEFAULT(1),
     .doc = "factor on the drag area"},
    {0}};
static const field_block air_brakes_block = {.fields = air_brakes_fields,
                                             .form = brakes_forms,
                                             .form_offset = offsetof(ld_air_brakes, form),
                                             .form_from_keys = true};

static const field_word line_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_word line_ends[] = {{"held", LD_LINE_HELD}, {"free", LD_LINE_FREE}, {NULL, 0}};
static const field_word line_containers[] = {
    {"ground", LD_LINE_ON_GROUND}, {"launcher", LD_LINE_ON_LAUNCHER}, {NULL, 0}};
static const field_row line_fields[] = {
    {"length", NUMBER(ld_line, length, "m"), ABOVE_TO(0, 1e5), REQUIRED,
     .doc = "of the whole line, unstretched"},
    {"mass_per_length", NUMBER(ld_line, mass_per_length, "kg/m"), ABOVE_TO(0, 100), REQUIRED,
     .doc = "dry, or wet as it is paid out"},
    {"diameter", NUMBER(ld_line, diameter, "m"), ABOVE_TO(0, 1), REQUIRED, .doc = "for the drag"},
    {"stiffness", NUMBER(ld_line, stiffness, "N"), ABOVE_TO(0, 1e9), REQUIRED,
     .doc = "EA: tension over strain"},
    {"damping", NUMBER(ld_line, damping, ""), FROM_TO(0, 1), DEFAULT(0.1),
     .doc = "of the motion of neighbouring points against each other, of the critical one"},
    {"breaking_force", NUMBER(ld_line, breaking_force, "N"), POSITIVE, NO_DEFAULT("unbreakable"),
     .doc = "tension at which it breaks"},
    {"drag_across", NUMBER(ld_line, drag_across, ""), FROM_TO(0, 10), DEFAULT(1.2),
     .doc = "coefficient of the speed across, on diameter times length"},
    {"drag_along", NUMBER(ld_line, drag_along, ""), FROM_TO(0, 1), DEFAULT(0.01),
     .doc = "coefficient of the speed along, on the surface"},
    {"bridle", VECTOR(ld_line, bridle, "m", 3), FROM_TO(-100, 100), DEFAULT(0),
     .doc = "point of the rocket that pulls it, in B"},
    {"container_on", CHOICE(ld_line, container_on, line_containers), DEFAULT(LD_LINE_ON_GROUND),
     .doc = "what the container stands on: the ground (`container` in I), or the launcher (in T, "
            "with which it moves)"},
    {"container", VECTOR(ld_line, container, "m", 3), FROM_TO(-1e4, 1e4), DEFAULT(0),
     .doc = "point where the line leaves its container"},
    {"tension", NUMBER(ld_line, tension, "N"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "with which the container holds the line that leaves it"},
    {"slack", NUMBER(ld_line, slack, "m"), FROM_TO(0, 1000), DEFAULT(0),
     .doc = "length that lies slack before the rocket starts"},
    {"end", CHOICE(ld_line, end, line_ends), DEFAULT(LD_LINE_HELD),
     .doc = "of the line in the container: held there, or free to leave it"},
    {"segments", INTEGER(ld_line, segments, 2, LD_LINE_MOST_SEGMENTS), DEFAULT(40),
     .doc = "of the whole length"},
    {0}};
static const field_block line_block = {.fields = line_fields};

// What carries the rocket: the form of the whole scenario and of the rocket.
#define KIND_WORD(name, word, number) {"base.kind: " #word, name},
static const field_word kind_words[] = {LD_BASE_KINDS(KIND_WORD){"flight", LD_BASE_NONE},
                                        {NULL, 0}};
#define OR_KIND(name, word, number) | FORM(name)
#define IN_TUBE .forms = 0 LD_BASE_KINDS(OR_KIND)
#define IN_FLIGHT FORM(LD_BASE_NONE)
#define NOT_IN_FLIGHT(text) .optional = IN_FLIGHT, .initial_doc = (text)
static const field_word motor_words[] = {{"", 0}, {"none", 1}, {NULL, 0}};

static const field_row rocket_fields[] = {
    {"start_at", NUMBER(ld_model, rocket.start_at, "m"), FROM_TO(0, 100), DEFAULT(0), IN_TUBE,
     .doc = "start position of the rear adaptor (the breech) from the tube's rear end"},
    {"mass", NUMBER(ld_model, rocket.full.mass, "kg"), POSITIVE, REQUIRED, .doc = "at ignition"},
    {"center", VECTOR(ld_model, rocket.full.center, "m", 3), FROM_TO(-100, 100), REQUIRED,
     NOT_IN_FLIGHT("0 m in flight only"), .doc = "mass centre from the rear adaptor, in B"},
    {"inertia", VECTOR(ld_model, rocket.full.inertia, "kg.m2", 3), POSITIVE, REQUIRED,
     .doc = "about the mass centre"},
    {"products_of_inertia", VECTOR(ld_model, rocket.products, "kg.m2", 3), ANY, DEFAULT(0),
     .doc = "elements J_xy, J_xz, J_yz of the matrix, full and empty"},
    {"dynamic_imbalance", VECTOR(ld_model, rocket.dynamic_imbalance, "rad", 2), FROM_TO(-1, 1),
     DEFAULT(0),
     .doc = "delta_y, delta_z: axes of inertia and products (full and empty), x along (1, delta_y, "
            "delta_z) of B"},
    {"mass_error", NUMBER(ld_model, rocket.mass_error, "kg"), ANY, DEFAULT(0),
     .doc = "added to full and empty mass, at the mass centre"},
    {"eccentricity", VECTOR(ld_model, rocket.eccentricity, "m", 2), FROM_TO(-10, 10), DEFAULT(0),
     .doc = "y, z, added to full and empty mass centre"},
    {"propellant", NUMBER(ld_model, rocket.propellant, "kg"), NOT_NEGATIVE,
     NO_DEFAULT("mass less empty"), .doc = "burnt mass"},
    {"empty", BLOCK(ld_model, rocket.empty, empty_block), .initial_doc = "as full",
     .doc = "at burn-out; without: constant mass"},
    {"adaptors",
     LIST(ld_model, rocket.adaptor, rocket.adaptor_count, adaptor_block, 2, LD_MAX_ADAPTORS),
     .required = true, IN_TUBE, .doc = "the first is the rear one, at 0 m"},
    {"contact", BLOCK(ld_model, rocket.contact, contact_block), .required = true, IN_TUBE,
     .doc = "between adaptors and tube"},
    {"knob", BLOCK(ld_model, rocket, knob_block), .initial_doc = "as below", IN_TUBE,
     .doc = "runs in the slot"},
    {"lock", BLOCK(ld_model, rocket.lock, lock_block), .required = true, IN_TUBE,
     SWITCH(ld_model, rocket.lock.present, lock_words), .other_is_bool = true,
     .doc = "holds the rocket until the release force; `none`: rests on the breech"},
    {"motor", BLOCK(ld_model, rocket.motor, motor_block), .required = true,
     NOT_IN_FLIGHT("none in flight only"), SWITCH(ld_model, rocket.motor.absent, motor_words),
     .other_is_bool = true, .doc = "thrust; `none`: flight only, or launch by tubes.pressure"},
    {"further_motors",
     LIST(ld_model, rocket.further_motor, rocket.further_motor_count, further_motor_block, 0,
          LD_MAX_FURTHER_MOTORS),
     .silent = true, .initial_doc = "none",
     .doc = "lit by the same signal, each after its delay; only with a motor"},
    {"parachutes",
     LIST(ld_model, rocket.parachute, rocket.parachute_count, parachute_block, 0,
          LD_MAX_PARACHUTES),
     .silent = true, .initial_doc = "none",
     .doc = "of the descent, each replaces the previous one"},
    {"air_brakes", BLOCK(ld_model, rocket.air_brakes, air_brakes_block), .initial_doc = "none",
     SWITCH(ld_model, rocket.air_brakes.present, brakes_words), .other_is_bool = true,
     .doc = "additional drag along the axis at the mass centre, in free flight"},
    {"line", BLOCK(ld_model, rocket.line, line_block), .initial_doc = "none",
     SWITCH(ld_model, rocket.line.present, line_words), .other_is_bool = true,
     .doc = "that the rocket pulls out of a container"},
    {"aerodynamics", BLOCK(ld_model, rocket.aerodynamics, aerodynamics_block),
     .initial_doc = "none", SWITCH(ld_model, rocket.aerodynamics.present, aerodynamics_words),
     .other_is_bool = true,
     .doc = "air forces in free flight and, on a guide of surfaces, from the start; in a bore by "
            "`emerged`"},
    {0}};
static const field_block rocket_block = {
    .fields = rocket_fields, .form = kind_words, .form_offset = offsetof(ld_model, base.kind)};

// ---- flight alone

static const field_word geodetic_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row geodetic_fields[] = {
    {"latitude", NUMBER(ld_flight, geodetic.latitude, "rad"), FROM_TO(-PI / 2, PI / 2), REQUIRED,
     .doc = "geodetic"},
    {"longitude", NUMBER(ld_flight, geodetic.longitude, "rad"), FROM_TO(-2 * PI, 2 * PI), REQUIRED,
     .doc = "positive to the east"},
    {"altitude", NUMBER(ld_flight, geodetic.altitude, "m"), FROM_TO(-1e4, 1e8), REQUIRED,
     .doc = "above the ellipsoid"},
    {0}};
static const field_block geodetic_block = {.fields = geodetic_fields};

static const field_word attitude_words[] = {{"an attitude against I", LD_ATTITUDE_YAW},
                                            {"an attitude against north", LD_ATTITUDE_HEADING},
                                            {"an attitude by quaternion", LD_ATTITUDE_QUATERNION},
                                            {NULL, 0}};
#define ANGLES .forms = FORM(LD_ATTITUDE_YAW) | FORM(LD_ATTITUDE_HEADING)
static const field_row attitude_fields[] = {
    {"yaw", NUMBER(ld_flight, yaw, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .forms = FORM(LD_ATTITUDE_YAW), .doc = "against I, about +y: positive to the left"},
    {"heading", NUMBER(ld_flight, heading, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0),
     .forms = FORM(LD_ATTITUDE_HEADING), .doc = "clockwise from north, in place of yaw"},
    {"pitch", NUMBER(ld_flight, pitch, "rad"), FROM_TO(-PI, PI), DEFAULT(0), ANGLES,
     .doc = "positive up"},
    {"roll", NUMBER(ld_flight, roll, "rad"), FROM_TO(-2 * PI, 2 * PI), DEFAULT(0), ANGLES,
     .doc = "about x of B"},
    {"quaternion", VECTOR(ld_flight, quaternion, "", 4), FROM_TO(-1e6, 1e6),
     NO_DEFAULT("the angles"), .forms = FORM(LD_ATTITUDE_QUATERNION),
     .doc = "as flight.quaternion"},
    {0}};
static const field_block attitude_block = {.fields = attitude_fields,
                                           .form = attitude_words,
                                           .form_offset = offsetof(ld_flight, attitude),
                                           .form_from_keys = true};

static const field_word point_words[] = {
    {"rear", LD_POINT_REAR}, {"center", LD_POINT_CENTER}, {NULL, 0}};
static const field_word against_words[] = {
    {"inertial", LD_AGAINST_INERTIAL}, {"earth", LD_AGAINST_EARTH}, {NULL, 0}};
static const field_row flight_fields[] = {
    {"ignition", NUMBER(ld_flight, ignition, "s"), FROM_TO(-10000, 10000), DEFAULT(0),
     .doc = "on the run's clock (0 at the start): sets thrust and burnt propellant"},
    {"point", CHOICE(ld_flight, point, point_words), DEFAULT(LD_POINT_REAR),
     .doc = "point of position and velocity: rear adaptor or mass centre"},
    {"position", VECTOR(ld_flight, position, "m", 3), FROM_TO(-1e8, 1e8),
     NO_DEFAULT("this or geodetic"), .doc = "in I"},
    {"geodetic", SAME_STRUCT(geodetic_block), .initial_doc = "none",
     SWITCH(ld_flight, geodetic.present, geodetic_words), .other_is_bool = true,
     .doc = "position on the Earth, in place of position"},
    {"velocity", VECTOR(ld_flight, velocity, "m/s", 3), FROM_TO(-1e5, 1e5),
     NO_DEFAULT("this, speed or velocity_ned"), .doc = "relative to the Earth, in I"},
    {"speed", NUMBER(ld_flight, speed, "m/s"), FROM_TO(-1e5, 1e5), NO_DEFAULT("see velocity"),
     .doc = "velocity along x of B"},
    {"velocity_ned", VECTOR(ld_flight, velocity_ned, "m/s", 3), FROM_TO(-1e5, 1e5),
     NO_DEFAULT("see velocity"), .doc = "towards north, east and down"},
    {"attitude", SAME_STRUCT(attitude_block), .initial_doc = "along I",
     .doc = "Ry(yaw) Rz(pitch) Rx(roll) against I, or Ry(-heading) Rz(pitch) Rx(roll) against "
            "north, up and east"},
    {"quaternion", VECTOR(ld_flight, quaternion, "", 4), FROM_TO(-1e6, 1e6),
     NO_DEFAULT("the attitude"), .doc = "of B against I, scalar first, in place of attitude"},
    {"rate", VECTOR(ld_flight, rate, "rad/s", 3), FROM_TO(-1e4, 1e4), DEFAULT(0),
     .doc = "angular velocity, in B"},
    {"rate_against", CHOICE(ld_flight, rate_against, against_words), DEFAULT(LD_AGAINST_INERTIAL),
     .doc = "reference of rate"},
    {0}};
static const field_block flight_block = {.fields = flight_fields};

// ---- firing, run

static const field_row firing_fields[] = {{"tube", INTEGER(ld_firing, tube, 1, 10000),
                                           .required = true,
                                           .doc = "number: (row - 1) columns + column"},
                                          {"at", NUMBER(ld_firing, at, "s"), FROM_TO(0, 10000),
                                           DEFAULT(0), .doc = "ignition, on the run's clock"},
                                          {0}};
static const field_block firing_block = {.fields = firing_fields};

static const field_row order_fields[] = {
    {"order", INTEGERS(ld_firing_order, tube, tube_count, 1, 10000, LD_MAX_FIRINGS), .least = 1,
     .required = true, .doc = "tubes in the order of firing"},
    {"start", NUMBER(ld_firing_order, start, "s"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "first ignition, on the run's clock"},
    {"interval", NUMBER(ld_firing_order, interval, "s"), ABOVE_TO(0, 10000), REQUIRED,
     .doc = "from one ignition to the next"},
    {0}};
static const field_block order_block = {.fields = order_fields};
static const field_word given_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row firing_order = {"firing", BLOCK(ld_model, firing_order, order_block),
                                       SWITCH(ld_model, firing_order.present, given_words),
                                       .other_is_bool = true};

#define OUTPUT_STEP(member) NUMBER(ld_run_settings, member, "s"), .range = {1e-6, 100, 0, 0}
static const field_row output_step_fields[] = {
    {"lead_in", OUTPUT_STEP(output_step_lead_in), DEFAULT(5e-3),
     .doc = "before ignition, and from an exit to the next ignition"},
    {"tube", OUTPUT_STEP(output_step_tube), DEFAULT(1e-4), .doc = "from ignition"},
    {"flight", OUTPUT_STEP(output_step_flight), DEFAULT(2e-2), .doc = "in free flight"},
    {0}};
static const field_block output_step_block = {.fields = output_step_fields, .shared_value = true};

static const field_row coupling_fields[] = {
    {"step", NUMBER(ld_run_settings, coupling_step, "s"), FROM_TO(0, 0.01), .required = true,
     .doc = "between exchanges; 0 s: monolithic integration"},
    {0}};
static const field_block coupling_block = {.fields = coupling_fields};

static const field_word start_words[] = {
    {"equilibrium", LD_START_EQUILIBRIUM}, {"undeformed", LD_START_UNDEFORMED}, {NULL, 0}};
static const field_word formulation_words[] = {
    {"reduced", LD_FORMULATION_REDUCED}, {"overall", LD_FORMULATION_OVERALL}, {NULL, 0}};
static const field_word lead_in_words[] = {
    {"explicit", LD_LEAD_IN_EXPLICIT}, {"exponential", LD_LEAD_IN_EXPONENTIAL}, {NULL, 0}};
static const field_word exit_error_words[] = {
    {"yes", LD_EXIT_ERROR_YES}, {"no", LD_EXIT_ERROR_NO}, {NULL, 0}};
static const field_word end_words[] = {{"tip", LD_END_TIP},
                                       {"", LD_END_TIME},
                                       {"apogee", LD_END_APOGEE},
                                       {"landing", LD_END_LANDING},
                                       {NULL, 0}};
static const field_row run_fields[] = {
    {"start", CHOICE(ld_run_settings, start, start_words), DEFAULT(LD_START_EQUILIBRIUM),
     .doc = "static equilibrium, or straight and at rest"},
    {"formulation", CHOICE(ld_run_settings, formulation, formulation_words),
     DEFAULT(LD_FORMULATION_REDUCED),
     .doc = "reduced transfer equation, or the overall one (order 19)"},
    {"lead_in", NUMBER(ld_run_settings, lead_in, "s"), FROM_TO(0, 10000), DEFAULT(0),
     .doc = "settling phase before t = 0"},
    {"lead_in_method", CHOICE(ld_run_settings, lead_in_method, lead_in_words),
     DEFAULT(LD_LEAD_IN_EXPONENTIAL),
     .doc =
         "steps while no rocket moves: as in the tube, or long ones by the linearised equations"},
    {"end", CHOICE(ld_run_settings, end, end_words), DEFAULT(LD_END_TIP),
     .other = offsetof(ld_run_settings, end_time), .unit = "s", .range = {0, 10000, 1, 0},
     .doc = "exit of the last rocket (flight only: landing), a time after the last ignition, "
            "apogee or landing of each"},
    {"tolerance", NUMBER(ld_run_settings, tolerance, ""), FROM_TO(1e-12, 1e-2), DEFAULT(1e-5),
     .doc = "relative tolerance of the integrator"},
    {"max_step", NUMBER(ld_run_settings, max_step, "s"), FROM_TO(1e-7, 1),
     NO_DEFAULT("0.2 ms, times (tolerance/1e-5)^(1/5) above 1e-5"),
     .doc = "longest step in the tube; longer ones can miss short contacts"},
    {"exit_error", CHOICE(ld_run_settings, exit_error, exit_error_words),
     DEFAULT(LD_EXIT_ERROR_YES), .doc = "estimate of the integration error of the exit rates"},
    {"output_step", SAME_STRUCT(output_step_block), .initial_doc = "as below",
     .doc = "time between rows of the history"},
    {"stuck_time", NUMBER(ld_run_settings, stuck_time, "s"), ABOVE_TO(0, 10000),
     NO_DEFAULT("end of the thrust table + 1 s"),
     .doc = "time after ignition at which a rocket still in the tube ends the run"},
    {"coupling", SAME_STRUCT(coupling_block), .initial_doc = "none",
     .doc = "partitioned integration of a vehicle's subsystems"},
    {"flight_limit", NUMBER(ld_run_settings, flight_limit, "s"), ABOVE_TO(0, 1e5), DEFAULT(600),
     .doc = "longest free flight"},
    {"flight_tolerance", NUMBER(ld_run_settings, flight_tolerance, ""), FROM_TO(1e-14, 1e-2),
     DEFAULT(1e-7), .doc = "relative tolerance of the integrator in free flight"},
    {0}};
static const field_block run_block = {.fields = run_fields};

// ---- results that are asked for

static const field_word take_words[] = {{"value", LD_TAKE_VALUE},
                                        {"peak", LD_TAKE_PEAK},
                                        {"change", LD_TAKE_CHANGE},
                                        {"rms", LD_TAKE_RMS},
                                        {"mean", LD_TAKE_MEAN},
                                        {"largest", LD_TAKE_LARGEST},
                                        {"least", LD_TAKE_LEAST},
                                        {"expression", LD_TAKE_EXPRESSION},
                                        {NULL, 0}};
#define IN_WINDOW                                                                                  \
    .forms = FORM(LD_TAKE_PEAK) | FORM(LD_TAKE_CHANGE) | FORM(LD_TAKE_RMS) | FORM(LD_TAKE_MEAN) |  \
             FORM(LD_TAKE_LARGEST) | FORM(LD_TAKE_LEAST)
#define OF_COLUMN (FORM(LD_TAKE_EXPRESSION) - 1u)
static const double all_of_it[] = {0, 1e5};
static const field_row measure_fields[] = {
    {"name", WORD(ld_measure, name), .required = true, .doc = "the result is measure.NAME"},
    {"take", CHOICE(ld_measure, take, take_words), .required = true,
     .doc = "value at an instant; in a window largest magnitude, largest change since `from`, rms, "
            "mean, largest or least value; `expression` need not be said"},
    {"of", QUANTITY(ld_measure, of), .required = true, .forms = OF_COLUMN,
     .doc = "column of launch or flight (quantities.md)"},
    {"at", QUANTITY(ld_measure, from), .required = true, .forms = FORM(LD_TAKE_VALUE),
     .doc = "instant"},
    {"from", QUANTITY(ld_measure, from), .required = true, IN_WINDOW, .doc = "start of the window"},
    {"to", QUANTITY(ld_measure, to), .required = true, IN_WINDOW, .doc = "end of the window"},
    {"within", VECTOR(ld_measure, within, "s", 2), FROM_TO(0, 1e5), .initials = all_of_it,
     IN_WINDOW, .initial_doc = "all of it",
     .doc = "part of the window between these times after `from`"},
    {"expression", .kind = FIELD_TEXT, .offset = offsetof(ld_measure, expression), .required = true,
     .forms = FORM(LD_TAKE_EXPRESSION), .doc = "of results and, over time, of columns"},
    {0}};
static const field_block measure_block = {.fields = measure_fields,
                                          .form = take_words,
                                          .form_offset = offsetof(ld_measure, take),
                                          .form_key = "take"};

// ---- studies

static const field_word plan_words[] = {{"random", LD_PLAN_RANDOM}, {"lhs", LD_PLAN_LHS},
                                        {"sobol", LD_PLAN_SOBOL},   {"saltelli", LD_PLAN_SALTELLI},
                                        {"morris", LD_PLAN_MORRIS}, {NULL, 0}};
static const field_row scatter_fields[] = {
    {"seed", INTEGER(ld_scatter, seed, 0, 999999999), DEFAULT(1),
     .doc = "of all random numbers of the study"},
    {"samples", INTEGER(ld_scatter, samples, 1, 100000000), .required = true,
     .doc = "runs, each of all rockets of the firing; with `saltelli` and `morris` rows of runs"},
    {"plan", CHOICE(ld_scatter, plan, plan_words), DEFAULT(LD_PLAN_RANDOM),
     .doc = "independent samples, Latin hypercubes, scrambled Sobol points; for sensitivities the "
            "plans of Saltelli and Morris (study.md)"},
    {"replicates", INTEGER(ld_scatter, replicates, 1, 1000000), DEFAULT(1),
     .forms = FORM(LD_PLAN_LHS) | FORM(LD_PLAN_SOBOL) | FORM(LD_PLAN_SALTELLI),
     .doc = "independent hypercubes or scramblings of samples/replicates each, for intervals; "
            "`saltelli` with 1: random numbers"},
    {"factors", .kind = FIELD_FACTORS, .offset = offsetof(ld_scatter, factor),
     .other = offsetof(ld_scatter, factor_count), .required = true,
     .doc = "uncertain numbers by path, or several by `paths` under a name"},
    {"correlated", .kind = FIELD_CORRELATED, .offset = offsetof(ld_scatter, correlated),
     .other = offsetof(ld_scatter, correlated_count), .initial_doc = "none",
     .doc = "groups of correlated factors"},
    {"until", .kind = FIELD_UNTIL, .offset = offsetof(ld_scatter, until),
     .other = offsetof(ld_scatter, until_count), .count = LD_MAX_UNTIL,
     .initial_doc = "all samples",
     .doc = "half widths of means or deviations at which the study stops"},
    {0}};
static const field_block scatter_block = {.fields = scatter_fields,
                                          .form = plan_words,
                                          .form_offset = offsetof(ld_scatter, plan),
                                          .form_key = "plan"};

// ---- the whole

static const field_row scenario_fields[] = {
    {"launchdyn", .kind = FIELD_INTEGER, .offset = FIELD_NOWHERE, .required = true,
     .range = {1, 1, 0, 0}, .doc = "version of the language"},
    {"title", .kind = FIELD_TEXT, .offset = offsetof(ld_model, title), .initial_doc = "none",
     .doc = "name of the scenario, one line"},
    {"environment", SAME_STRUCT(environment_block), .initial_doc = "as below",
     .doc = "gravity, Earth, air and wind"},
    {"base", BLOCK(ld_model, base, base_block), .required = true, IN_TUBE,
     .doc = "base of the tube"},
    {"platform", BLOCK(ld_model, platform, platform_block), .required = true, .forms = VEHICLE,
     .doc = "chassis and platforms of a vehicle"},
    {"tubes", BLOCK(ld_model, tubes, tubes_block), .required = true, IN_TUBE,
     .doc = "launch tubes, all equal"},
    {"rocket", SAME_STRUCT(rocket_block), .required = true, .doc = "the rocket"},
    {"firing", LIST(ld_model, firing, firing_count, firing_block, 1, LD_MAX_FIRINGS),
     .alternative = &firing_order, IN_TUBE, .initial_doc = "tube 1 at 0 s",
     .doc = "tubes and ignition times"},
    {"run", BLOCK(ld_model, run, run_block), .initial_doc = "as below",
     .doc = "start, end, tolerances, output"},
    {"measures", LIST(ld_model, measure, measure_count, measure_block, 0, LD_MAX_MEASURES),
     .silent = true, .initial_doc = "none", .doc = "user-defined results"},
    {"flight", BLOCK(ld_model, flight, flight_block), .required = true, .forms = IN_FLIGHT,
     .doc = "scenario of flight only, without launcher"},
    {"scatter", BLOCK(ld_model, scatter, scatter_block), .initial_doc = "none",
     SWITCH(ld_model, scatter.present, given_words), .other_is_bool = true,
     .doc = "uncertain inputs of a study"},
    {"optimise", BLOCK(ld_model, optimise, optimise_block), .initial_doc = "none",
     SWITCH(ld_model, optimise.present, given_words), .other_is_bool = true,
     .doc = "keys with bounds, and what `launchdyn optimise` makes least"},
    {"sweep", .kind = FIELD_SWEEP, .offset = offsetof(ld_model, sweep),
     .other = offsetof(ld_model, sweep_count), .initial_doc = "none",
     .doc = "keys with values that a study combines"},
    {0}};
const field_block scenario_block = {.fields = scenario_fields,
                                    .form = kind_words,
                                    .form_offset = offsetof(ld_model, base.kind),
                                    .last_form = "flight"};
