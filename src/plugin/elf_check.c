/* elf_check.c: whether a shared object is whole.
 *
 * The dynamic loader maps the segments that a file's headers name without asking whether the file
 * reaches that far; a truncated one kills the process at the first touch. So the sizes are compared
 * first.
 */
#include "plugin/elf_check.h"

#include <elf.h>
#include <link.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static bool read_at(FILE *file, uint64_t offset, void *data, size_t size)
{
    return fseek(file, (long)offset, SEEK_SET) == 0 && fread(data, 1, size, file) == size;
}

static const char *check_segments(FILE *file, const ElfW(Ehdr) * header, uint64_t size)
{
    for (unsigned i = 0; i < header->e_phnum; i++) {
        ElfW(Phdr) segment;
        uint64_t offset = header->e_phoff + (uint64_t)i * header->e_phentsize;
        if (offset > size || !read_at(file, offset, &segment, sizeof segment))
            return "it is truncated: its segment table is missing";
        if (segment.p_type == PT_LOAD &&
            (segment.p_offset > size || segment.p_filesz > size - segment.p_offset))
            return "it is truncated: a segment reaches past the end of the file";
    }
    return NULL;
}

static const char *check_file(FILE *file)
{
    ElfW(Ehdr) header;
    if (!read_at(file, 0, &header, sizeof header) || memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
        return "it is no shared object";
    if (header.e_type != ET_DYN || header.e_phentsize != sizeof(ElfW(Phdr)))
        return "it is no shared object";
    if (fseek(file, 0, SEEK_END) != 0)
        return "it can't be read";
    long size = ftell(file);
    return size < 0 ? "it can't be read" : check_segments(file, &header, (uint64_t)size);
}

const char *elf_problem(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return "it can't be opened";
    const char *problem = check_file(file);
    fclose(file);
    return problem;
}
