// The columns and instants of which measures are.
#ifndef LD_RUN_MEASURE_NAMES_H
#define LD_RUN_MEASURE_NAMES_H

#include "quantities/measuring.h"
#include "quantities/quantity_table.h"

enum { MEASURE_TABLES = 3 };

// Whether the instant is one of a flight alone.
bool measure_is_of_flight(const char *instant);
// Whether a measure is of a column of the flight.
bool measure_is_in_flight(const ld_model *model, const ld_measure *measure);
// The tables of a launch's columns, or of a flight's; NULL: no more.
void measure_tables_of(const ld_model *model, bool flight,
                       const quantity_table *tables[MEASURE_TABLES]);

// What a column is searched among.
typedef struct column_search {
    quantity_things things;
    const quantity_table *table[MEASURE_TABLES];
} column_search;

column_search measure_columns(const ld_model *model, bool flight);
// The column of that name; row NULL: there is none.
quantity_walk measure_column_named(const column_search *search, const char *name);
// Its place in a row, columns standing in the order of the tables; -1: there is none.
int measure_column_number(const column_search *search, const char *name);
// The name that may be meant, or "".
void measure_nearest_column(const column_search *search, const char *name,
                            char near[QUANTITY_NAME]);

// Unit of a quantity, SI; "" or "1": none. A measure has that of its column or
// expression.
const char *quantity_unit(const quantity_walk *at);
// That of measure `item` of a model, from 0.
const char *measure_unit(const ld_model *model, int item);

typedef struct instant_row {
    const char *name;
    measure_instant instant;
} instant_row;

// The instants of a model's rockets, in their order of time but for exits of single adaptors; those
// of a flight in the order in which they most often come. `exits`: room for names.
enum { MEASURE_MOST_INSTANTS = 10 + LD_MAX_ADAPTORS };
int measure_list_instants(const ld_model *model, char exits[LD_MAX_ADAPTORS][LD_MAX_QUANTITY],
                          instant_row row[MEASURE_MOST_INSTANTS]);
bool measure_instant_named(const ld_model *model, const char *name, measure_instant *instant);
// Which of two comes first: below, at or above 0.
int measure_compare_instants(const ld_model *model, measure_instant a, measure_instant b);

#endif
