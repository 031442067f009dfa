/* steps.h: what is made of a mesh file, a function for each kind of thing. */
#ifndef IMPORT_STEPS_H
#define IMPORT_STEPS_H

#include "import/job.h"

/* Materials and textures; fills job->materials. First, since objects refer to them. */
ps_result mesh_read_materials(struct mesh_job *job);

/* Meshes and objects; materials of meshes that have vertex colours take these. */
ps_result mesh_read_objects(struct mesh_job *job);

/* Materials whose meshes have no vertex colours do without. */
void mesh_settle_materials(struct mesh_job *job);

/* What materials have and psplat has not. Last. */
void mesh_note_omissions(struct mesh_job *job);

/* Textures of a kind that psplat does not read. */
void mesh_note_textures(struct mesh_job *job);

ps_result mesh_read_cameras(struct mesh_job *job);
ps_result mesh_read_lights(struct mesh_job *job);

#endif
