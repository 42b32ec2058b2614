// Any bytes as a file of pending records give back records that can be read, or none. The input
// begins with a digit: '0', the bytes are the file; else changes of a file of three records, place
// (3 bytes) and value (8 bytes), with '2' under right digests, which other records follow.
#include <math.h>
#include <stdint.h>

#include "fuzz/memory_folder.h"
#include "studies/store/pending.c"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { RECORDS = 3, CHANGE = 11 };

static const study_shape shape = {.rockets = 2, .of_sample = 3, .of_rocket = 1, .results = 4};

static void open_file(study_pending *pending)
{
    ld_error error = {0};
    must(pending_open(pending, in_memory("study.pending"), 1, &shape, &error) == LD_OK);
}

static void add_record(study_pending *pending, int64_t number)
{
    study_record *record = calloc(1, record_size(&shape));
    must(record != NULL);
    record->number = number;
    record->shape = shape;
    pending_add(pending, record);
    free(record);
}

// Whether a digest of a record of this shape can be taken in its slot.
static bool fits(const study_shape *of)
{
    return of->rockets >= 0 && of->rockets <= shape.rockets && of->of_sample >= 0 &&
           of->of_sample <= shape.of_sample && of->of_rocket >= 0 &&
           of->of_rocket <= shape.of_rocket && of->results >= 0 && of->results <= shape.results;
}

static void write_changed(const uint8_t *data, size_t size, bool sealed)
{
    study_pending pending;
    open_file(&pending);
    for (int i = 0; i < RECORDS; i++)
        add_record(&pending, i + 1);
    for (; size >= CHANGE; data += CHANGE, size -= CHANGE) {
        size_t at =
            (size_t)(data[0] | data[1] << 8 | data[2] << 16) % (RECORDS * pending.slot_size);
        size_t room = PENDING_MOST * pending.slot_size - at;
        memcpy(pending.slot + at, data + 3, room < 8 ? room : 8);
    }
    for (int i = 0; i < RECORDS && sealed; i++)
        if (fits(&record_in(&pending, i)->shape))
            *digest_in(&pending, i) = digest(&pending, record_in(&pending, i));
    pending_close(&pending);
}

// Goes through all that is given back, adds one more and gives all back.
static void read_all(void)
{
    study_pending pending;
    double sum = 0;
    open_file(&pending);
    int count = pending.count;
    must(count >= 0 && count <= PENDING_MOST);
    for (int i = 0; i < count; i++) {
        const study_record *record = pending_read(&pending, i);
        must(record->number > 0);
        must(memchr(record->reason, 0, sizeof record->reason) != NULL);
        for (int64_t k = 0; k < record_rocket(&record->shape, record->shape.rockets); k++)
            sum += record->value[k];
    }
    if (count < PENDING_MOST)
        add_record(&pending, 99);
    pending_close(&pending);
    open_file(&pending);
    must(!(sum < -INFINITY));
    must(pending.count == count + (count < PENDING_MOST));
    pending_clear(&pending);
    pending_close(&pending);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 1)
        return 0;
    remove(in_memory("study.pending"));
    if (data[0] == '0')
        write_in_memory("study.pending", data + 1, size - 1);
    else
        write_changed(data + 1, size - 1, data[0] == '2');
    read_all();
    return 0;
}
