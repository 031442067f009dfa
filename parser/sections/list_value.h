/* list_value.h: keys whose values are lists of numbers, points or words. */
#ifndef PARSER_SECTIONS_LIST_VALUE_H
#define PARSER_SECTIONS_LIST_VALUE_H

#include "parser/schema/keys.h"
#include "parser/sections/value.h"

/* Each reads the list into the member of its form (schema.h), whose memory is the caller's to free;
 * false where something was reported. */
bool list_points(struct reader *reader, struct subject subject, const struct schema_row *row,
                 const struct node *list, struct point_list *points);
bool list_pairs(struct reader *reader, struct subject subject, const struct schema_row *row,
                const struct node *list, struct pair_list *pairs);
/* Indices are of `point_count` points; 0: of any number, as the points were wrong. */
bool list_triangles(struct reader *reader, struct subject subject, const struct schema_row *row,
                    const struct node *list, size_t point_count, struct triangle_list *triangles);
bool list_colors(struct reader *reader, struct subject subject, const struct schema_row *row,
                 const struct node *list, ps_rgb *colors);
bool list_words(const struct reader *reader, struct subject subject, const struct schema_row *row,
                const struct node *list, int32_t *words);
bool list_matrix(const struct reader *reader, struct subject subject, const struct schema_row *row,
                 const struct node *list, double matrix[12]);

/* [u, v], or one number for both. */
bool list_pair(const struct reader *reader, struct subject subject, const struct node *node,
               double pair[2]);

#endif
