// A history.h5.part whose groups, datasets and attributes are of any kind and shape, and whose
// values are any numbers, is read, refused with a sentence, or shown as far as it goes. The input
// is changes of a true file, a line each: what ("history/t", "rockets/1@tube"; a name that is not
// there is any one that is), the change and its detail, two numbers.
#include <stdint.h>

#include <hdf5.h>
#include <math.h>

#include "base/random.h"
#include "fuzz/must_say.h"
#include "fuzz/small_run.h"
#include "launchdyn/origin.h"
#include "report/report_parts.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { NAMES = 2000, LINE = 160, MOST_CHANGES = 12 };

// Something in the file: an object by its path, or, with a name, an attribute of it.
typedef struct place {
    char object[120], attribute[40];
} place;

static place places[NAMES];
static size_t place_count;
static uint8_t *template;
static size_t template_size;

static herr_t list_attribute(hid_t object, const char *name, const H5A_info_t *info, void *path)
{
    (void)object, (void)info;
    must(place_count < NAMES);
    place *at = &places[place_count++];
    snprintf(at->object, sizeof at->object, "%s", (const char *)path);
    snprintf(at->attribute, sizeof at->attribute, "%s", name);
    return 0;
}

static herr_t list_object(hid_t file, const char *path, const H5O_info_t *info, void *self)
{
    (void)self, (void)info;
    char text[120];
    snprintf(text, sizeof text, "%s", path);
    must(place_count < NAMES);
    snprintf(places[place_count].attribute, sizeof places->attribute, "%s", "");
    snprintf(places[place_count++].object, sizeof places->object, "%s", path);
    hid_t object = H5Oopen(file, path, H5P_DEFAULT);
    H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, NULL, list_attribute, text);
    H5Oclose(object);
    return 0;
}

// Leaves some columns of a table, so that an input takes milliseconds.
static herr_t drop_column(hid_t group, const char *name, const H5L_info_t *info, void *self)
{
    static const char *const kept[] = {
        "t",          "phase",     "thrust", "base.x",   "base.y",   "base.z",   "base.yaw",
        "base.pitch", "base.roll", "tube.x", "tube.y",   "tube.z",   "tube.q0",  "tube.q1",
        "tube.q2",    "tube.q3",   "tip.y",  "altitude", "center.x", "center.y", "angle_of_attack"};
    (void)info, (void)self;
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++)
        if (strcmp(name, kept[i]) == 0)
            return 0;
    return H5Ldelete(group, name, H5P_DEFAULT);
}

static void drop_columns(hid_t file, const char *table)
{
    hid_t group = H5Gopen2(file, table, H5P_DEFAULT);
    must(group >= 0);
    H5Literate(group, H5_INDEX_CRT_ORDER, H5_ITER_DEC, NULL, drop_column, NULL);
    H5Gclose(group);
}

static void make_once(void)
{
    if (template)
        return;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    write_small_run();
    hid_t file = H5Fopen(in_memory("run/history.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
    must(file >= 0);
    drop_columns(file, "history");
    drop_columns(file, "rockets/1/flight");
    drop_columns(file, "rockets/2/flight");
    H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, list_object, NULL, H5O_INFO_BASIC);
    H5Fclose(file);
    template = read_in_memory("run/history.h5", &template_size);
    write_in_memory("other", template, template_size);
    remove(in_memory("run/history.h5"));
    remove(in_memory("run/summary.json"));
}

// ---- what stands in the place of something

// A type of eight kinds, to be closed.
static hid_t type_of(unsigned kind)
{
    hid_t type;
    switch (kind % 8) {
    case 0:
        return H5Tcopy(H5T_NATIVE_DOUBLE);
    case 1:
        return H5Tcopy(H5T_NATIVE_SCHAR);
    case 2:
        return H5Tcopy(H5T_STD_U64BE);
    case 3: // text of a fixed length
        type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, 1 + kind / 8);
        return type;
    case 4: // of any length
        type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        return type;
    case 5:
        type = H5Tcreate(H5T_COMPOUND, 16);
        H5Tinsert(type, "a", 0, H5T_NATIVE_DOUBLE);
        H5Tinsert(type, "b", 8, H5T_NATIVE_INT);
        return type;
    case 6:
        return H5Tvlen_create(H5T_NATIVE_DOUBLE);
    default:
        return H5Tcopy(H5T_NATIVE_B32);
    }
}

// A space of eight shapes, to be closed.
static hid_t space_of(unsigned shape)
{
    static const hsize_t none[] = {0}, one[] = {1}, some[] = {17}, flat[] = {3, 2},
                         empty[] = {4, 0}, deep[] = {2, 2, 2};
    switch (shape % 8) {
    case 0:
        return H5Screate(H5S_SCALAR);
    case 1:
        return H5Screate(H5S_NULL);
    case 2:
        return H5Screate_simple(1, none, NULL);
    case 3:
        return H5Screate_simple(1, one, NULL);
    case 4:
        return H5Screate_simple(1, some, NULL);
    case 5:
        return H5Screate_simple(2, flat, NULL);
    case 6:
        return H5Screate_simple(2, empty, NULL);
    default:
        return H5Screate_simple(3, deep, NULL);
    }
}

// Bytes for all that fits, but no pointers.
static const void *filling(hid_t type, unsigned detail)
{
    static uint8_t bytes[1 << 13];
    memset(bytes, (int)detail, sizeof bytes);
    bool pointers = H5Tis_variable_str(type) > 0 || H5Tget_class(type) == H5T_VLEN;
    return pointers ? NULL : bytes;
}

static void put_attribute(hid_t object, const char *name, hid_t type, hid_t space, unsigned detail)
{
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute >= 0 && filling(type, detail))
        H5Awrite(attribute, type, filling(type, detail));
    if (attribute >= 0)
        H5Aclose(attribute);
}

static void put_dataset(hid_t file, const char *path, hid_t type, hid_t space, unsigned detail)
{
    hid_t dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (dataset >= 0 && filling(type, detail))
        H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, filling(type, detail));
    if (dataset >= 0)
        H5Dclose(dataset);
}

// A dataset that says it has very many rows, and has none.
static void put_endless(hid_t file, const char *path, unsigned detail)
{
    hsize_t rows = (hsize_t)1 << detail % 62, chunk = 64;
    hid_t space = H5Screate_simple(1, &rows, NULL), properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 1, &chunk);
    hid_t dataset =
        H5Dcreate2(file, path, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    if (dataset >= 0)
        H5Dclose(dataset);
    H5Pclose(properties);
    H5Sclose(space);
}

// ---- changes

static void change_attribute(hid_t object, const char *name, unsigned change, unsigned detail)
{
    H5Adelete(object, name);
    if (change % 8 == 0)
        return;
    hid_t type = type_of(change % 8 == 1 ? 0 : detail), space = space_of(detail / 8);
    if (change % 8 == 2) { // a single number
        H5Sclose(space);
        space = H5Screate(H5S_SCALAR);
    }
    put_attribute(object, name, type, space, change / 8);
    H5Sclose(space);
    H5Tclose(type);
}

static void change_object(hid_t file, const char *path, unsigned change, unsigned detail)
{
    hid_t type = type_of(detail), space = space_of(detail / 8);
    if (change % 8 != 7)
        H5Ldelete(file, path, H5P_DEFAULT);
    switch (change % 8) {
    case 0: // gone
        break;
    case 1:
        H5Gclose(H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        break;
    case 2:
        if (detail & 2)
            H5Lcreate_external(in_memory("other"), "/", file, path, H5P_DEFAULT, H5P_DEFAULT);
        else
            H5Lcreate_soft(detail & 1 ? "/" : path, file, path, H5P_DEFAULT, H5P_DEFAULT);
        break;
    case 3: // another's in its place
        H5Lcreate_hard(file, places[detail % place_count].object, file, path, H5P_DEFAULT,
                       H5P_DEFAULT);
        break;
    case 4:
        put_endless(file, path, detail);
        break;
    case 5:
    case 6:
        put_dataset(file, path, type, space, change / 8);
        break;
    default: { // its numbers
        hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
        hid_t of = dataset >= 0 ? H5Dget_space(dataset) : -1;
        double values[1024];
        for (size_t i = 0; i < 1024; i++)
            values[i] = detail & 1   ? NAN
                        : detail & 2 ? INFINITY
                                     : (detail & 4 ? 1e308 : -1.0) * (double)i;
        if (of >= 0 && H5Sget_simple_extent_npoints(of) <= 1024)
            H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
        H5Sclose(of);
        H5Dclose(dataset);
    }
    }
    H5Sclose(space);
    H5Tclose(type);
}

// The place that a name says.
static const place *place_named(const char *name)
{
    char text[sizeof(place) + 1];
    for (size_t i = 0; i < place_count; i++) {
        snprintf(text, sizeof text, "%.119s@%.39s", places[i].object, places[i].attribute);
        if (strncmp(text, name, strlen(name)) == 0 &&
            (text[strlen(name)] == '\0' || strcmp(text + strlen(name), "@") == 0))
            return &places[i];
    }
    return &places[random_stream(name) % place_count];
}

static void change_place(hid_t file, const char *line)
{
    char name[LINE];
    unsigned change, detail;
    if (sscanf(line, "%159s %u %u", name, &change, &detail) != 3)
        return;
    const place *at = place_named(name);
    hid_t object = H5Oopen(file, at->object, H5P_DEFAULT);
    if (object >= 0 && at->attribute[0])
        change_attribute(object, at->attribute, change, detail % 256);
    else if (object >= 0 && strcmp(at->object, ".") != 0)
        change_object(file, at->object, change, detail % 256);
    if (object >= 0)
        H5Oclose(object);
}

static void write_changed(const uint8_t *data, size_t size)
{
    char line[LINE] = "";
    write_in_memory("run/history.h5.part", template, template_size);
    hid_t file = H5Fopen(in_memory("run/history.h5.part"), H5F_ACC_RDWR, H5P_DEFAULT);
    must(file >= 0);
    for (size_t i = 0, length = 0, lines = 0; i < size && lines < MOST_CHANGES; i++) {
        bool ends = data[i] == '\n' || length == LINE - 1;
        line[length] = ends ? '\0' : (char)data[i];
        length = ends ? 0 : length + 1;
        if (ends)
            change_place(file, line);
        lines += ends;
    }
    H5Fclose(file);
}

// ---- reading

// What the report and the plots make of it.
static void show(history_data *history)
{
    ld_report report = {0};
    ld_error error = {0};
    const plot_figure *figure[64];
    const char *name[] = {"run"};
    char *text = NULL;
    size_t length, count = 0;
    report_source *source = calloc(1, sizeof *source);
    report_detail detail = {.pixel = 0.01};
    must(source != NULL);
    must_say(report_add_replay(history, &error), &error);
    *source = (report_source){.has_history = true, .history = *history, .report = &report};
    FILE *stream = open_memstream(&text, &length);
    must_say(report_write_data(stream, source, &detail, &error), &error);
    for (size_t i = 0; count < 64 && (figure[count] = plot_figure_at(i)) != NULL; i++)
        count += plot_figure_has_columns(figure[count], history);
    plot_page page = {.run = history,
                      .style = plot_style_find(NULL, NULL),
                      .width = 1000,
                      .name = name,
                      .runs = 1,
                      .figure = figure,
                      .figures = count,
                      .from = NAN,
                      .to = NAN};
    if (count > 0)
        must_say(plot_write_script(stream, &page, PLOT_SVG, &error), &error);
    fclose(stream);
    free(text);
    free(source);
}

static void read_all(void)
{
    history_data history;
    ld_origin origin;
    ld_error error = {0};
    const char *path = in_memory("run/history.h5.part");
    ld_status status = history_read(path, &history, &error);
    must_say(status, &error);
    if (status == LD_OK)
        show(&history);
    history_free(&history);
    status = ld_origin_read(in_memory("run"), &origin, &error);
    must_say(status, &error);
    char differs[256];
    must(!ld_origin_differs(&origin, differs, sizeof differs) || differs[0]);
    ld_origin_free(&origin);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    make_once();
    write_changed(data, size);
    read_all();
    return 0;
}
