#include "fmu/pack/fmu_icon.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include <zlib.h>

#include "math/functions.h"
#include "model/blocks/base.h"
#include "model/parts.h"

enum { SIZE = FMU_ICON_SIZE, MOST_SHAPES = 16, MOST_CORNERS = 24, SUB = 4 };

// A polygon in pixels, y down.
typedef struct shape {
    unsigned colour; // red, green, blue
    int corners;
    double x[MOST_CORNERS], y[MOST_CORNERS];
} shape;

// The latter cover the former.
typedef struct drawing {
    int count;
    shape shape[MOST_SHAPES];
} drawing;

enum { GREY = 0x8a929c, STEEL = 0x54667a, DARK = 0x2c3a4a, SEA = 0x4c86b8, ROCKET = 0xd24a2c };

// ---- what is drawn ----

static void add(drawing *self, unsigned colour, int corners, const double (*at)[2])
{
    shape *next = &self->shape[self->count++];
    next->colour = colour;
    next->corners = corners;
    for (int i = 0; i < corners; i++) {
        next->x[i] = at[i][0];
        next->y[i] = at[i][1];
    }
}

static void add_box(drawing *self, unsigned colour, double left, double top, double right,
                    double bottom)
{
    add(self, colour, 4,
        (const double[][2]){{left, top}, {right, top}, {right, bottom}, {left, bottom}});
}

static void add_wheel(drawing *self, double x, double y, double radius)
{
    double at[MOST_CORNERS][2];
    for (int i = 0; i < MOST_CORNERS; i++) {
        double angle = 2 * 3.141592653589793 * i / MOST_CORNERS;
        at[i][0] = x + radius * cos(angle);
        at[i][1] = y + radius * sin(angle);
    }
    add(self, DARK, MOST_CORNERS, (const double(*)[2])at);
}

// A box along the tube, which points 33 deg up about its pivot.
static void add_along(drawing *self, unsigned colour, const double (*at)[2], int corners)
{
    const double c = cos(0.576), s = sin(0.576);
    double turned[MOST_CORNERS][2];
    for (int i = 0; i < corners; i++) {
        turned[i][0] = 56 + c * at[i][0] + s * at[i][1];
        turned[i][1] = 72 - s * at[i][0] + c * at[i][1];
    }
    add(self, colour, corners, (const double(*)[2])turned);
}

static void add_launcher(drawing *self)
{
    add_along(self, ROCKET, (const double[][2]){{40, -6}, {60, -6}, {74, 0}, {60, 6}, {40, 6}}, 5);
    add_along(self, DARK, (const double[][2]){{-44, -11}, {48, -11}, {48, 11}, {-44, 11}}, 4);
    add_along(self, GREY, (const double[][2]){{-44, -3}, {48, -3}, {48, 3}, {-44, 3}}, 4);
}

static void add_base(drawing *self, const ld_model *model)
{
    const ld_base *base = model_base(model);
    if (model_has_vehicle(model)) {
        add_box(self, STEEL, 46, 72, 66, 90);
        add_box(self, STEEL, 10, 88, 118, 100);
        for (int i = 0; i < 3; i++)
            add_wheel(self, 28 + 36 * i, 103, 11);
        add_box(self, GREY, 4, 114, 124, 118);
    } else if (base->looks == LD_LOOKS_SHIP) {
        add(self, STEEL, 4, (const double[][2]){{46, 90}, {50, 70}, {62, 70}, {66, 90}});
        add(self, STEEL, 4, (const double[][2]){{4, 88}, {124, 88}, {104, 116}, {20, 116}});
        add_box(self, SEA, 0, 108, 128, 122);
    } else {
        add(self, STEEL, 4, (const double[][2]){{40, 114}, {50, 70}, {62, 70}, {72, 114}});
        add_box(self, GREY, 4, 114, 124, 118);
    }
}

static void draw(const ld_model *model, ld_fmu_part part, drawing *self)
{
    self->count = 0;
    if (part != LD_FMU_LAUNCHER)
        add_base(self, model);
    if (part != LD_FMU_VEHICLE)
        add_launcher(self);
}

void fmu_icon_write_svg(const ld_model *model, ld_fmu_part part, FILE *stream)
{
    drawing self;
    draw(model, part, &self);
    fprintf(stream,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d "
            "%d\">\n",
            SIZE, SIZE, SIZE, SIZE);
    for (int i = 0; i < self.count; i++) {
        const shape *one = &self.shape[i];
        fprintf(stream, "<polygon fill=\"#%06x\" points=\"", one->colour);
        for (int k = 0; k < one->corners; k++)
            fprintf(stream, "%s%.2f,%.2f", k ? " " : "", one->x[k], one->y[k]);
        fputs("\"/>\n", stream);
    }
    fputs("</svg>\n", stream);
}

// ---- the picture of it ----

static bool is_inside(const shape *one, double x, double y)
{
    bool inside = false;
    for (int i = 0, k = one->corners - 1; i < one->corners; k = i++)
        if ((one->y[i] > y) != (one->y[k] > y) &&
            x < one->x[i] + (one->x[k] - one->x[i]) * (y - one->y[i]) / (one->y[k] - one->y[i]))
            inside = !inside;
    return inside;
}

// The shape that is seen at a point; NULL: none.
static const shape *seen(const drawing *self, double x, double y)
{
    for (int i = self->count - 1; i >= 0; i--)
        if (is_inside(&self->shape[i], x, y))
            return &self->shape[i];
    return NULL;
}

// The mean of some points of a pixel: red, green, blue, how much is covered.
static void paint(const drawing *self, int column, int row, unsigned char pixel[4])
{
    int sum[3] = {0}, covered = 0;
    for (int i = 0; i < SUB * SUB; i++) {
        const int across = i % SUB, down = i / SUB;
        const shape *one = seen(self, column + (across + 0.5) / SUB, row + (down + 0.5) / SUB);
        for (int k = 0; k < 3 && one; k++)
            sum[k] += one->colour >> (16 - 8 * k) & 255;
        covered += one != NULL;
    }
    for (int k = 0; k < 3; k++)
        pixel[k] = (unsigned char)(covered ? sum[k] / covered : 0);
    pixel[3] = (unsigned char)(255 * covered / (SUB * SUB));
}

static void put_number(unsigned char bytes[4], uint32_t number)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(number >> (24 - 8 * i));
}

static void write_chunk(FILE *stream, const char *type, const unsigned char *bytes, size_t size)
{
    unsigned char number[4];
    put_number(number, (uint32_t)size);
    fwrite(number, 1, 4, stream);
    fwrite(type, 1, 4, stream);
    fwrite(bytes, 1, size, stream);
    uLong sum = crc32(crc32(0, (const Bytef *)type, 4), bytes, (uInt)size);
    put_number(number, (uint32_t)sum);
    fwrite(number, 1, 4, stream);
}

// Portable Network Graphics (ISO/IEC 15948): 8 bits each of red, green, blue, alpha; rows without
// filter.
bool fmu_icon_write_png(const ld_model *model, ld_fmu_part part, FILE *stream)
{
    enum { ROW = 1 + 4 * SIZE, PIXELS = SIZE * ROW };
    static const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    unsigned char head[13] = {[8] = 8, [9] = 6}, *rows = malloc(3 * PIXELS);
    if (!rows)
        return false;
    unsigned char *packed = rows + PIXELS;
    drawing self;
    uLongf size = 2 * PIXELS;
    draw(model, part, &self);
    for (int row = 0; row < SIZE; row++) {
        rows[row * ROW] = 0;
        for (int column = 0; column < SIZE; column++)
            paint(&self, column, row, &rows[row * ROW + 1 + 4 * column]);
    }
    put_number(head, SIZE);
    put_number(head + 4, SIZE);
    compress2(packed, &size, rows, PIXELS, Z_BEST_COMPRESSION); // into twice the room
    fwrite(signature, 1, sizeof signature, stream);
    write_chunk(stream, "IHDR", head, sizeof head);
    write_chunk(stream, "IDAT", packed, size);
    write_chunk(stream, "IEND", head, 0);
    free(rows);
    return true;
}
