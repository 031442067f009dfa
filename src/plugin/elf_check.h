/* elf_check.h: whether a shared object may safely be given to the dynamic loader. */
#ifndef PLUGIN_ELF_CHECK_H
#define PLUGIN_ELF_CHECK_H

/* NULL if the file looks like a whole shared object; otherwise what is wrong, as a literal. */
const char *elf_problem(const char *path);

#endif
