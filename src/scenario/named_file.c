// Files that a scenario names, beside the text that names them: texts, which are kept, and others,
// of which it is kept where they lie and what they were when they were read first.
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/base64.h"
#include "base/text_file.h"
#include "model/fields/digest.h"
#include "model/fields/source.h"
#include "scenario/foreign_tables.h"
#include "scenario/scenario_reader.h"

// The name of a file beside others in a folder, in the pool.
static char *path_in_folder(scenario_reader *reader, const char *folder, const char *name)
{
    bool alone = name[0] == '/' || !folder || !folder[0];
    size_t length = strlen(name) + (alone ? 0 : strlen(folder)) + 2;
    char *joined = pool_take(reader, length);
    if (joined)
        snprintf(joined, length, "%s%s%s", alone ? "" : folder, alone ? "" : "/", name);
    return joined;
}

// The folder part of a file's name: "" without.
static char *folder_of(scenario_reader *reader, const char *name)
{
    const char *slash = strrchr(name, '/');
    return pool_text(reader, name, slash == name ? 1 : slash ? (size_t)(slash - name) : 0);
}

// Whether a file lies in the folder or below, whatever links lead there; one that is not there
// does.
static bool lies_within(const char *folder, const char *file_name)
{
    char *outer = realpath(folder[0] ? folder : ".", NULL), *inner = realpath(file_name, NULL);
    size_t length = outer ? strlen(outer) : 0;
    length -= length == 1; // of "/"
    bool within = !inner || (outer && strncmp(inner, outer, length) == 0 && inner[length] == '/');
    free(outer);
    free(inner);
    return within;
}

// Whether a file may be opened: files of a source that is confined lie within its folder. False
// after a message.
static bool may_open(scenario_reader *reader, text_place place, const char *path,
                     const char *file_name)
{
    const ld_source *source = reader->source;
    if (!source->confined || lies_within(source->folder, file_name))
        return true;
    reader_refuse(reader, place, path,
                  "file \"%s\" lies outside the scenario's folder, expected one in it", file_name);
    return false;
}

// A file's text, which it takes over: base64 in place of a mesh's bytes, as what a run keeps are
// texts. NULL: no memory.
static char *kept_text(char *text, size_t *length)
{
    text_writer kept = {0};
    if (*length < strlen(MESH_FILE_HEAD) ||
        memcmp(text, MESH_FILE_HEAD, strlen(MESH_FILE_HEAD)) != 0)
        return text;
    base64_write(&kept, text, *length);
    free(text);
    return text_take(&kept, length);
}

// Reads a file into the source, as `within`; NULL after a message.
static const ld_source_file *read_file(scenario_reader *reader, text_place place, const char *path,
                                       const char *file_name, const char *within)
{
    char *text;
    size_t length;
    ld_error error;
    if (!reader->source->folder) {
        reader_refuse(reader, place, path, "file \"%s\" is not among the stored texts", within);
        return NULL;
    }
    if (!may_open(reader, place, path, file_name))
        return NULL;
    ld_status status = text_file_read(file_name, READER_MAX_BYTES, &text, &length, &error);
    if (!status && !(text = kept_text(text, &length)))
        status = ld_fail(&error, LD_ERR_MEMORY, "cannot be read: no memory");
    reader->no_memory |= status == LD_ERR_MEMORY;
    reader->no_file |= status == LD_ERR_FILE;
    if (status != LD_OK) {
        reader_refuse(reader, place, path, "file \"%s\" %s", file_name, error.text);
        return NULL;
    }
    const ld_source_file *file = source_add(reader->source, within, text, length);
    reader->no_memory |= !file;
    return file;
}

text_source *reader_open(scenario_reader *reader, text_place place, const char *path,
                         const char *name)
{
    char *file_name = path_in_folder(reader, place.source->folder, name);
    char *within = path_in_folder(reader, place.source->within, name);
    if (!file_name || !within)
        return NULL;
    const ld_source_file *file = source_find(reader->source, within);
    if (!file)
        file = read_file(reader, place, path, file_name, within);
    text_source *opened = file ? pool_take(reader, sizeof *opened) : NULL;
    if (opened)
        *opened = (text_source){.name = file_name,
                                .text = file->text,
                                .length = file->length,
                                .folder = folder_of(reader, file_name),
                                .first_line = 1,
                                .within = folder_of(reader, within)};
    return reader->no_memory ? NULL : opened;
}

// "FNV-1a DIGEST of SIZE bytes", in the pool.
static const char *digest_text(scenario_reader *reader, uint64_t digest, size_t size)
{
    char text[64];
    int length = snprintf(text, sizeof text, "FNV-1a %016" PRIx64 " of %zu bytes", digest, size);
    return pool_text(reader, text, (size_t)length);
}

// Of a file; where it cannot be read, a sentence without its name.
static ld_status digest_of(scenario_reader *reader, const char *file_name, const char **text,
                           ld_error *error)
{
    unsigned char part[1 << 14];
    struct stat about;
    uint64_t digest = DIGEST_BEGIN;
    size_t size = 0, got;
    FILE *file = fopen(file_name, "rb");
    if (!file)
        return text_file_failed(error);
    if (fstat(fileno(file), &about) != 0 || !S_ISREG(about.st_mode)) {
        fclose(file);
        return ld_fail(error, LD_ERR_INPUT, "is not a regular file");
    }
    while ((got = fread(part, 1, sizeof part, file)) > 0) {
        digest = digest_bytes(digest, part, got);
        size += got;
    }
    ld_status status = ferror(file) ? text_file_failed(error) : LD_OK;
    fclose(file);
    *text = digest_text(reader, digest, size);
    return status;
}

// NULL after a message.
static const char *take_digest(scenario_reader *reader, text_place place, const char *path,
                               const char *file_name)
{
    const char *text = NULL;
    ld_error error;
    if (!may_open(reader, place, path, file_name))
        return NULL;
    ld_status status = digest_of(reader, file_name, &text, &error);
    reader->no_memory |= status == LD_ERR_MEMORY;
    reader->no_file |= status == LD_ERR_FILE;
    if (status)
        reader_refuse(reader, place, path, "file \"%s\" %s", file_name, error.text);
    return status ? NULL : text;
}

// Puts "DIGEST: PATH" into the source.
static const ld_source_file *keep_file(scenario_reader *reader, const char *digest,
                                       const char *file_name, const char *within)
{
    char *whole = realpath(file_name, NULL);
    text_writer to = {0};
    size_t length;
    if (whole)
        text_print(&to, "%s: %s", digest, whole);
    char *text = whole ? text_take(&to, &length) : NULL;
    free(whole);
    const ld_source_file *kept = text ? source_add(reader->source, within, text, length) : NULL;
    reader->no_memory |= !kept;
    return kept;
}

// `*digest`: as take_digest reports it.
static const ld_source_file *read_first(scenario_reader *reader, text_place place, const char *path,
                                        const char *file_name, const char *within,
                                        const char **digest)
{
    if (reader->source->folder)
        *digest = take_digest(reader, place, path, file_name);
    else
        reader_refuse(reader, place, path, "file \"%s\" is not among the stored files", within);
    return *digest ? keep_file(reader, *digest, file_name, within) : NULL;
}

// The file is as it was when it was read first, or as the scenario says; false after a message.
static bool check_digest(scenario_reader *reader, text_place place, const char *path,
                         const char *file_name, const char *then, const char *now)
{
    bool same = strcmp(then, now) == 0;
    if (!same)
        reader_refuse(reader, place, path, "file \"%s\" has changed: expected %s, found %s",
                      file_name, then, now);
    return same;
}

const char *reader_keep(scenario_reader *reader, text_place place, const char *path,
                        const char *name, const char **digest)
{
    const char *file_name = path_in_folder(reader, place.source->folder, name);
    const char *within = path_in_folder(reader, place.source->within, name);
    if (!file_name || !within)
        return NULL;
    const char *now = NULL;
    const ld_source_file *kept = source_find(reader->source, within);
    if (!kept)
        kept = read_first(reader, place, path, file_name, within, &now);
    const char *colon = kept ? strstr(kept->text, ": /") : NULL;
    if (kept && !colon)
        reader_refuse(reader, place, path, "the path of file \"%s\" was not stored", within);
    if (!colon)
        return NULL;
    const char *whole = colon + 2;
    if (!now)
        now = take_digest(reader, place, path, whole);
    const char *then = pool_text(reader, kept->text, (size_t)(colon - kept->text));
    if (!now || !then || !check_digest(reader, place, path, whole, *digest ? *digest : then, now))
        return NULL;
    *digest = now;
    return check_digest(reader, place, path, whole, then, now) ? whole : NULL;
}
