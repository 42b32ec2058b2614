// The tables of a base of bodies, joints and force elements (model/blocks/mechanism.h).
#include "model/fields/tables_mechanism.h"

#include "model/fields/field_rows.h"
#include "model/fields/tables_parts.h"

#define PI 3.14159265358979323846
#define PLACE FROM_TO(-1000, 1000)
#define TURN FROM_TO(-2 * PI, 2 * PI)
#define NAME_OF(type, what)                                                                        \
    {                                                                                              \
        "name", WORD(type, name), .required = true, .doc = what                                    \
    }

// ---- bodies

static const field_word shape_words[] = {{"inertia", LD_SHAPE_INERTIA},
                                         {"box", LD_SHAPE_BOX},
                                         {"cylinder", LD_SHAPE_CYLINDER},
                                         {"ellipsoid", LD_SHAPE_ELLIPSOID},
                                         {"none", LD_SHAPE_NONE},
                                         {"mesh", LD_SHAPE_MESH},
                                         {NULL, 0}};
#define CORNER(x, y, z)                                                                            \
    {x, .unit = "m", ANY}, {y, .unit = "m", ANY},                                                  \
    {                                                                                              \
        z, .unit = "m", ANY                                                                        \
    }
static const field_row mesh_columns[] = {CORNER("x1", "y1", "z1"),
                                         CORNER("x2", "y2", "z2"),
                                         CORNER("x3", "y3", "z3"),
                                         {"red", .unit = "", FROM_TO(0, 1)},
                                         {"green", .unit = "", FROM_TO(0, 1)},
                                         {"blue", .unit = "", FROM_TO(0, 1)}};
static const table_format mesh_table = {TABLE_MESH, LD_MESH_COLUMNS, mesh_columns, NULL};
#define SIZED                                                                                      \
    (FORM(LD_SHAPE_INERTIA) | FORM(LD_SHAPE_BOX) | FORM(LD_SHAPE_CYLINDER) |                       \
     FORM(LD_SHAPE_ELLIPSOID) | FORM(LD_SHAPE_NONE))
#define MESH FORM(LD_SHAPE_MESH)
static const field_row looks_fields[] = {
    {"shape", CHOICE(ld_appearance, shape, shape_words), DEFAULT(LD_SHAPE_INERTIA),
     .doc = "the box of its mass and inertia, or what `at` and `size` or `mesh` give"},
    {"at", VECTOR(ld_appearance, at, "m", 3), PLACE, DEFAULT(0),
     .doc = "its centre, of a mesh its origin, body axes"},
    {"attitude", VECTOR(ld_appearance, attitude, "rad", 3), TURN, DEFAULT(0),
     .doc = "yaw, pitch, roll of its axes against the body's"},
    {"size", VECTOR(ld_appearance, size, "m", 3), FROM_TO(0, 1000), DEFAULT(1), .forms = SIZED,
     .doc = "lengths along its x, y, z; a cylinder's axis is x"},
    {"mesh", TABLE(ld_appearance, mesh, mesh_table), .required = true, .forms = MESH,
     .doc = "triangles, at most 5000 in all meshes: corners in the axes of the mesh, colour from 0 "
            "to 1, linear"},
    {"scale", NUMBER(ld_appearance, scale, ""), ABOVE_TO(0, 1e6), DEFAULT(1), .forms = MESH,
     .doc = "factor of the mesh"},
    {0}};
static const field_block looks_block = {.fields = looks_fields,
                                        .form = shape_words,
                                        .form_offset = offsetof(ld_appearance, shape),
                                        .form_key = "shape"};

static const field_row body_fields[] = {
    NAME_OF(ld_body, "its name in results and paths"),
    {"mass", NUMBER(ld_body, mass, "kg"), NOT_NEGATIVE, REQUIRED, .doc = "mass"},
    {"center", VECTOR(ld_body, center, "m", 3), PLACE, DEFAULT(0),
     .doc = "mass centre from the body's origin, which is where its joint carries it"},
    {"inertia", VECTOR(ld_body, inertia, "kg.m2", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "about the mass centre, body axes"},
    {"products_of_inertia", VECTOR(ld_body, products, "kg.m2", 3), ANY, DEFAULT(0),
     .doc = "elements J_xy, J_xz, J_yz of the inertia matrix"},
    {"looks", BLOCK(ld_body, appearance, looks_block), .initial_doc = "the box of its inertia",
     .doc = "appearance in the replay"},
    {0}};
const field_block body_block = {.fields = body_fields};

static const double beam_modes[] = {4};
static const field_word geometric_words[] = {
    {"no", LD_GEOMETRIC_NO}, {"yes", LD_GEOMETRIC_YES}, {NULL, 0}};
static const field_word beam_span_words[] = {
    {"tip-loaded", LD_SPAN_TIP_LOADED}, {"clamped", LD_SPAN_CLAMPED}, {NULL, 0}};
static const field_row beam_mode_fields[] = {
    {"bending", INTEGER(ld_modes, bending, 1, LD_MAX_BENDING_MODES), DEFAULT(4),
     .initials = beam_modes, .doc = "bending modes a plane"},
    {"torsion", INTEGER(ld_modes, torsion, 0, LD_MAX_TORSION_MODES), DEFAULT(1),
     .doc = "torsion modes"},
    {"axial", INTEGER(ld_modes, axial, 0, LD_MAX_AXIAL_MODES), DEFAULT(0), .doc = "axial modes"},
    {"elements", INTEGER(ld_modes, elements, 2, 400), DEFAULT(40),
     .doc = "finite elements along the beam, at least"},
    {"damping", NUMBER(ld_modes, damping, ""), FROM_TO(0, 1), DEFAULT(0.01),
     .doc = "damping ratio of the modes clamped at the rear end"},
    {"span", CHOICE(ld_modes, span, beam_span_words), DEFAULT(LD_SPAN_TIP_LOADED),
     .doc =
         "boundary conditions of the modes: clamped at the rear end; tip-loaded: the last ones of "
         "them replaced by the static shapes of a force and a moment at the tip"},
    {"geometric_stiffness", CHOICE(ld_modes, geometric_stiffness, geometric_words),
     DEFAULT(LD_GEOMETRIC_YES),
     .doc = "geometric stiffness: axial forces stiffen or soften bending"},
    {"shear_coefficient", NUMBER(ld_modes, shear_coefficient, ""), FROM_TO(0, 1), DEFAULT(0),
     .doc = "k of k G A of round sections, about 0.53 of thin tubes, 0.89 of rods; with rotary "
            "inertia. 0: neither shear nor rotary inertia"},
    {0}};
static const field_block beam_modes_block = {.fields = beam_mode_fields};
static const field_row beam_fields[] = {
    NAME_OF(ld_beam, "its name in results and paths"),
    {"length", NUMBER(ld_beam, length, "m"), ABOVE_TO(0, 1000), REQUIRED,
     .doc = "along its x axis, from where its joint carries it"},
    {"material", BLOCK(ld_beam, material, material_block), .initial_doc = "none",
     .doc = "of sections that do not give stiffnesses"},
    {"sections", LIST(ld_beam, section, section_count, section_block, 1, LD_MAX_BEAM_SECTIONS),
     .required = true, .doc = "stretches of constant section, as of the tube"},
    {"modes", BLOCK(ld_beam, modes, beam_modes_block), .initial_doc = "as below",
     .doc = "shapes in which it deforms"},
    {0}};
const field_block beam_block = {.fields = beam_fields};

// ---- joints

static const field_word joint_words[] = {{"fixed", LD_JOINT_FIXED},
                                         {"revolute", LD_JOINT_REVOLUTE},
                                         {"prismatic", LD_JOINT_PRISMATIC},
                                         {"cylindrical", LD_JOINT_CYLINDRICAL},
                                         {"universal", LD_JOINT_UNIVERSAL},
                                         {"spherical", LD_JOINT_SPHERICAL},
                                         {"planar", LD_JOINT_PLANAR},
                                         {"free", LD_JOINT_FREE},
                                         {NULL, 0}};
#define REVOLUTE FORM(LD_JOINT_REVOLUTE)
#define PRISMATIC FORM(LD_JOINT_PRISMATIC)
#define CYLINDRICAL FORM(LD_JOINT_CYLINDRICAL)
#define UNIVERSAL FORM(LD_JOINT_UNIVERSAL)
#define SPHERICAL FORM(LD_JOINT_SPHERICAL)
#define PLANAR FORM(LD_JOINT_PLANAR)
#define FREE FORM(LD_JOINT_FREE)
#define WITH_AXIS (REVOLUTE | PRISMATIC | CYLINDRICAL | UNIVERSAL | PLANAR)
#define SLIDING (PRISMATIC | CYLINDRICAL | PLANAR | FREE)
#define TURNING (REVOLUTE | CYLINDRICAL | UNIVERSAL | SPHERICAL | PLANAR | FREE)

static const field_row turn_friction_fields[] = {
    {"viscous", NUMBER(ld_hinge_friction, viscous, "N.m.s/rad"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "viscous friction"},
    {"coulomb", NUMBER(ld_hinge_friction, coulomb, "N.m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "Coulomb friction"},
    {"rate", NUMBER(ld_hinge_friction, rate, "rad/s"), POSITIVE, DEFAULT(1e-3),
     .doc = "at which Coulomb friction reaches 71 %"},
    {0}};
static const field_block turn_friction_block = {.fields = turn_friction_fields};
static const field_row slide_friction_fields[] = {
    {"viscous", NUMBER(ld_hinge_friction, viscous, "N.s/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "viscous friction"},
    {"coulomb", NUMBER(ld_hinge_friction, coulomb, "N"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "Coulomb friction"},
    {"speed", NUMBER(ld_hinge_friction, rate, "m/s"), POSITIVE, DEFAULT(1e-3),
     .doc = "at which Coulomb friction reaches 71 %"},
    {0}};
static const field_block slide_friction_block = {.fields = slide_friction_fields};

static const field_row turn_stop_fields[] = {
    {"from", NUMBER(ld_joint_stops, low, "rad"), ANY, NO_DEFAULT("none"), .doc = "least angle"},
    {"to", NUMBER(ld_joint_stops, high, "rad"), ANY, NO_DEFAULT("none"), .doc = "greatest angle"},
    {"stiffness", NUMBER(ld_joint_stops, stiffness, "N.m/rad"), POSITIVE, REQUIRED,
     .doc = "beyond"},
    {"damping", NUMBER(ld_joint_stops, damping, "N.m.s/rad"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "while a stop presses"},
    {0}};
static const field_block turn_stop_block = {.fields = turn_stop_fields};
static const field_row slide_stop_fields[] = {
    {"from", NUMBER(ld_joint_stops, low, "m"), ANY, NO_DEFAULT("none"),
     .doc = "least displacement"},
    {"to", NUMBER(ld_joint_stops, high, "m"), ANY, NO_DEFAULT("none"),
     .doc = "greatest displacement"},
    {"stiffness", NUMBER(ld_joint_stops, stiffness, "N/m"), POSITIVE, REQUIRED, .doc = "beyond"},
    {"damping", NUMBER(ld_joint_stops, damping, "N.s/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "while a stop presses"},
    {0}};
static const field_block slide_stop_block = {.fields = slide_stop_fields};

static const field_word lock_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
#define LOCKED_FROM                                                                                \
    {                                                                                              \
        "from", NUMBER(ld_joint_lock, from, "s"), ANY, NO_DEFAULT("from the start"),               \
            .doc = "instant of the run's clock at which it closes"                                 \
    }
static const field_row turn_lock_fields[] = {
    {"stiffness", NUMBER(ld_joint_lock, spring.stiffness, "N.m/rad"), POSITIVE, REQUIRED,
     .doc = "about the axis, from the angle at which the lock closes"},
    {"damping", NUMBER(ld_joint_lock, spring.damping, "N.m.s/rad"), NOT_NEGATIVE, REQUIRED,
     .doc = "about the axis"},
    LOCKED_FROM,
    {0}};
static const field_block turn_lock_block = {.fields = turn_lock_fields};
static const field_row slide_lock_fields[] = {
    {"stiffness", NUMBER(ld_joint_lock, spring.stiffness, "N/m"), POSITIVE, REQUIRED,
     .doc = "along the axis, from the displacement at which the lock closes"},
    {"damping", NUMBER(ld_joint_lock, spring.damping, "N.s/m"), NOT_NEGATIVE, REQUIRED,
     .doc = "along the axis"},
    LOCKED_FROM,
    {0}};
static const field_block slide_lock_block = {.fields = slide_lock_fields};

static const double along_x[] = {1, 0, 0};
static const double along_y[] = {0, 1, 0};
static const field_row joint_fields[] = {
    NAME_OF(ld_joint, "its name in results and paths"),
    {"kind", CHOICE(ld_joint, kind, joint_words), .required = true,
     .doc = "what it lets free; planar: slides across its axis, turns about it"},
    {"parent", WORD(ld_joint, parent), .required = true,
     .doc = "what carries it: a body, a beam, `ground`, or `carrier`, the frame that moves as "
            "velocity, motion and sea say"},
    {"body", WORD(ld_joint, body), .required = true,
     .doc = "what it carries: a body or a beam at its origin; one that another joint carries "
            "already: a closed loop"},
    {"at", VECTOR(ld_joint, at, "m", 3), PLACE, DEFAULT(0),
     .doc = "its position on the parent; on a beam station, then y and z of the section there"},
    {"attitude", VECTOR(ld_joint, attitude, "rad", 3), TURN, DEFAULT(0),
     .doc = "yaw, pitch, roll of its axes against the parent's"},
    {"body_at", VECTOR(ld_joint, body_at, "m", 3), PLACE, NO_DEFAULT("its origin"),
     .doc = "position on the body of a joint that closes a loop"},
    {"body_attitude", VECTOR(ld_joint, body_attitude, "rad", 3), TURN, DEFAULT(0),
     .doc = "yaw, pitch, roll of its axes against the body's, for a joint that closes a loop"},
    {"axis", VECTOR(ld_joint, axis, "", 3), FROM_TO(-1e6, 1e6), DEFAULT(1), .initials = along_x,
     .forms = WITH_AXIS, .doc = "axis in its own axes, of any length"},
    {"axis_2", VECTOR(ld_joint, axis_2, "", 3), FROM_TO(-1e6, 1e6), DEFAULT(0), .initials = along_y,
     .forms = UNIVERSAL, .doc = "second axis, turned by the first angle"},
    {"angle", NUMBER(ld_joint, angle, "rad"), TURN, DEFAULT(0),
     .forms = REVOLUTE | CYLINDRICAL | UNIVERSAL, .doc = "about the axis at the start"},
    {"angle_2", NUMBER(ld_joint, angle_2, "rad"), TURN, DEFAULT(0), .forms = UNIVERSAL,
     .doc = "about the second axis at the start"},
    {"displacement", NUMBER(ld_joint, displacement, "m"), PLACE, DEFAULT(0),
     .forms = PRISMATIC | CYLINDRICAL, .doc = "along the axis at the start"},
    {"rate", NUMBER(ld_joint, rate, "rad/s"), FROM_TO(-1000, 1000), DEFAULT(0),
     .forms = REVOLUTE | CYLINDRICAL, .doc = "about the axis at the start"},
    {"speed", NUMBER(ld_joint, speed, "m/s"), FROM_TO(-1000, 1000), DEFAULT(0),
     .forms = PRISMATIC | CYLINDRICAL, .doc = "along the axis at the start"},
    {"stiffness", NUMBER(ld_joint, stiffness, "N/m"), NOT_NEGATIVE, DEFAULT(0), .forms = SLIDING,
     .doc = "of a spring along each direction in which it slides"},
    {"damping", NUMBER(ld_joint, damping, "N.s/m"), NOT_NEGATIVE, DEFAULT(0), .forms = SLIDING,
     .doc = "of a damper there"},
    {"rest_length", NUMBER(ld_joint, rest_length, "m"), PLACE, DEFAULT(0),
     .forms = PRISMATIC | CYLINDRICAL, .doc = "displacement without spring force"},
    {"rotational_stiffness", NUMBER(ld_joint, rotational_stiffness, "N.m/rad"), NOT_NEGATIVE,
     DEFAULT(0), .forms = TURNING, .doc = "of a spring about each axis about which it turns"},
    {"rotational_damping", NUMBER(ld_joint, rotational_damping, "N.m.s/rad"), NOT_NEGATIVE,
     DEFAULT(0), .forms = TURNING, .doc = "of a damper there"},
    {"rest_angle", NUMBER(ld_joint, rest_angle, "rad"), TURN, DEFAULT(0),
     .forms = REVOLUTE | CYLINDRICAL, .doc = "angle without spring moment"},
    {"friction", BLOCK(ld_joint, friction, turn_friction_block), .initial_doc = "none",
     .forms = REVOLUTE, .doc = "about the axis"},
    {"slide_friction", BLOCK(ld_joint, friction, slide_friction_block), .initial_doc = "none",
     .forms = PRISMATIC, .doc = "along the axis"},
    {"stops", BLOCK(ld_joint, stops, turn_stop_block), .initial_doc = "none",
     SWITCH(ld_joint, stops.present, lock_words), .other_is_bool = true, .forms = REVOLUTE,
     .doc = "springs beyond a range of the angle"},
    {"slide_stops", BLOCK(ld_joint, stops, slide_stop_block), .initial_doc = "none",
     SWITCH(ld_joint, stops.present, lock_words), .other_is_bool = true, .forms = PRISMATIC,
     .doc = "springs beyond a range of the displacement"},
    {"lock", BLOCK(ld_joint, lock, turn_lock_block), .initial_doc = "none",
     SWITCH(ld_joint, lock.spring.present, lock_words), .other_is_bool = true, .forms = REVOLUTE,
     .doc = "spring-damper that holds it where it stands when the lock closes"},
    {"slide_lock", BLOCK(ld_joint, lock, slide_lock_block), .initial_doc = "none",
     SWITCH(ld_joint, lock.spring.present, lock_words), .other_is_bool = true, .forms = PRISMATIC,
     .doc = "spring-damper that holds it where it stands when the lock closes"},
    {0}};
const field_block joint_block = {.fields = joint_fields,
                                 .form = joint_words,
                                 .form_offset = offsetof(ld_joint, kind),
                                 .form_key = "kind"};

// ---- force elements

#define FROM_AND_TO(type)                                                                          \
    {"from", WORD(type, from), .required = true, .doc = "body, beam, `ground` or `carrier`"},      \
    {                                                                                              \
        "to", WORD(type, to), .required = true, .doc = "the other one"                             \
    }
static const field_row bushing_fields[] = {
    NAME_OF(ld_bushing, "its name in results and paths"),
    FROM_AND_TO(ld_bushing),
    {"at", VECTOR(ld_bushing, at, "m", 3), PLACE, DEFAULT(0), .doc = "position on `from`"},
    {"attitude", VECTOR(ld_bushing, attitude, "rad", 3), TURN, DEFAULT(0),
     .doc = "yaw, pitch, roll of the springs' axes against those of `from`"},
    {"to_at", VECTOR(ld_bushing, to_at, "m", 3), PLACE,
     NO_DEFAULT("where it meets `at` at the start"), .doc = "position on `to`"},
    {"stiffness", VECTOR(ld_bushing, stiffness, "N/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "along its x, y, z"},
    {"damping", VECTOR(ld_bushing, damping, "N.s/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "along x, y, z"},
    {"rotational_stiffness", VECTOR(ld_bushing, rotational_stiffness, "N.m/rad", 3), NOT_NEGATIVE,
     DEFAULT(0), .doc = "about x, y, z; without moment as the bodies stand at the start"},
    {"rotational_damping", VECTOR(ld_bushing, rotational_damping, "N.m.s/rad", 3), NOT_NEGATIVE,
     DEFAULT(0), .doc = "about x, y, z"},
    {"clearance", VECTOR(ld_bushing, clearance, "m", 3), FROM_TO(0, 10), DEFAULT(0),
     .doc = "free play on each side along x, y, z, in which springs and dampers do not act"},
    {"stop", VECTOR(ld_bushing, stop, "m", 3), ABOVE_TO(0, 100), NO_DEFAULT("none"),
     .doc = "displacement along x, y, z at which stops on both sides begin"},
    {"stop_stiffness", VECTOR(ld_bushing, stop_stiffness, "N/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "added beyond"},
    {0}};
const field_block bushing_block = {.fields = bushing_fields};

static const field_word present_words[] = {{"none", 0}, {"", 1}, {NULL, 0}};
static const field_row strut_fields[] = {
    NAME_OF(ld_strut, "its name in results and paths"),
    FROM_AND_TO(ld_strut),
    {"at", VECTOR(ld_strut, at, "m", 3), PLACE, DEFAULT(0), .doc = "its end on `from`"},
    {"to_at", VECTOR(ld_strut, to_at, "m", 3), PLACE, DEFAULT(0), .doc = "its end on `to`"},
    {"stiffness", NUMBER(ld_strut, stiffness, "N/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "of its spring"},
    {"damping", NUMBER(ld_strut, damping, "N.s/m"), NOT_NEGATIVE, DEFAULT(0),
     .doc = "of its damper"},
    {"length", NUMBER(ld_strut, length, "m"), ABOVE_TO(0, 1000), NO_DEFAULT("that of the start"),
     .doc = "of the unloaded spring"},
    {"preload", NUMBER(ld_strut, preload, "N"), ANY, DEFAULT(0),
     .doc = "force at that length, positive where it pushes"},
    {"actuator", BLOCK(ld_strut, actuator, positioner_block), .initial_doc = "none",
     SWITCH(ld_strut, driven, present_words), .other_is_bool = true,
     .doc = "holds the commanded length, as a stabiliser an angle: a hydraulic cylinder by its "
            "lag (bandwidth) and force limit"},
    {0}};
const field_block strut_block = {.fields = strut_fields};

static const field_word follows_words[] = {
    {"joint", LD_FOLLOWS_JOINT}, {"yaw", LD_FOLLOWS_YAW}, {"pitch", LD_FOLLOWS_PITCH}, {NULL, 0}};
static const field_word drive_forms[] = {
    {"a drive of an angle", LD_DRIVE_ANGLE}, {"a drive of a length", LD_DRIVE_LENGTH}, {NULL, 0}};
static const field_row joint_drive_fields[] = {
    NAME_OF(ld_joint_drive, "its name in results and paths"),
    {"joint", WORD(ld_joint_drive, joint), .required = true,
     .doc = "revolute or prismatic joint on which it acts"},
    {"follows", CHOICE(ld_joint_drive, follows, follows_words), DEFAULT(LD_FOLLOWS_JOINT),
     .forms = FORM(LD_DRIVE_ANGLE),
     .doc = "what its command is for: the joint's angle, or yaw or pitch of a body's x axis in I"},
    {"of", WORD(ld_joint_drive, of), .initial_doc = "the one that carries the tube",
     .forms = FORM(LD_DRIVE_ANGLE), .doc = "body of that yaw or pitch"},
    {"angle", BLOCK(ld_joint_drive, angle, stabiliser_block), .required = true,
     .forms = FORM(LD_DRIVE_ANGLE), .doc = "stabiliser of a revolute joint, as on a platform"},
    {"length", BLOCK(ld_joint_drive, length, positioner_block), .required = true,
     .forms = FORM(LD_DRIVE_LENGTH), .doc = "the same of a prismatic joint's displacement"},
    {0}};
const field_block joint_drive_block = {.fields = joint_drive_fields,
                                       .form = drive_forms,
                                       .form_offset = offsetof(ld_joint_drive, form),
                                       .form_from_keys = true};

static const field_row foot_fields[] = {
    NAME_OF(ld_foot, "its name in results and paths"),
    {"body", WORD(ld_foot, body), .required = true, .doc = "body or beam that stands on it"},
    {"at", VECTOR(ld_foot, at, "m", 3), PLACE, REQUIRED, .doc = "its position there"},
    {"height", NUMBER(ld_foot, height, "m"), FROM_TO(-1000, 1000), DEFAULT(0),
     .doc = "y of the ground under it"},
    {"stiffness", VECTOR(ld_foot, stiffness, "N/m", 3), POSITIVE, REQUIRED,
     .doc = "of foot and ground along x, vertical, along z of I; it presses, and never pulls"},
    {"damping", VECTOR(ld_foot, damping, "N.s/m", 3), NOT_NEGATIVE, DEFAULT(0),
     .doc = "along x, vertical, along z"},
    {"friction", NUMBER(ld_foot, friction, ""), ABOVE_TO(0, 10), REQUIRED,
     .doc = "Coulomb coefficient of foot and ground"},
    {0}};
const field_block foot_block = {.fields = foot_fields};

static const field_word load_axes_words[] = {
    {"ground", LD_LOAD_IN_GROUND}, {"body", LD_LOAD_IN_BODY}, {NULL, 0}};
static const field_row force_columns[] = {{"t", .unit = "s", ANY},
                                          {"x", .unit = "N", ANY},
                                          {"y", .unit = "N", ANY},
                                          {"z", .unit = "N", ANY}};
static const table_format force_table = {TABLE_CSV, 4, force_columns, NULL};
static const field_row moment_columns[] = {{"t", .unit = "s", ANY},
                                           {"x", .unit = "N.m", ANY},
                                           {"y", .unit = "N.m", ANY},
                                           {"z", .unit = "N.m", ANY}};
static const table_format moment_table = {TABLE_CSV, 4, moment_columns, NULL};
static const field_row load_fields[] = {
    NAME_OF(ld_point_load, "its name in results and paths"),
    {"body", WORD(ld_point_load, body), .required = true, .doc = "body or beam on which it acts"},
    {"at", VECTOR(ld_point_load, at, "m", 3), PLACE, DEFAULT(0), .doc = "its position there"},
    {"axes", CHOICE(ld_point_load, axes, load_axes_words), DEFAULT(LD_LOAD_IN_GROUND),
     .doc = "of force and moment: those of I, or of the body"},
    {"force", TABLE(ld_point_load, force, force_table), .initial_doc = "none",
     .doc = "over time, linear between rows, constant outside"},
    {"moment", TABLE(ld_point_load, moment, moment_table), .initial_doc = "none",
     .doc = "over time, linear between rows, constant outside"},
    {0}};
const field_block load_block = {.fields = load_fields};

static const field_row drag_fields[] = {
    NAME_OF(ld_body_drag, "its name in paths"),
    {"body", WORD(ld_body_drag, body), .required = true, .doc = "body or beam in the wind"},
    {"at", VECTOR(ld_body_drag, at, "m", 3), PLACE, DEFAULT(0), .doc = "where its force acts"},
    {"area", VECTOR(ld_body_drag, area, "m2", 3), NOT_NEGATIVE, REQUIRED,
     .doc = "drag coefficient times area along x, y, z of the body"},
    {0}};
const field_block drag_block = {.fields = drag_fields};
