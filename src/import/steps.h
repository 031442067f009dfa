/* steps.h: what is made of a mesh file, a function for each kind of thing. */
#ifndef IMPORT_STEPS_H
#define IMPORT_STEPS_H

#include "import/job.h"

/* Materials and textures; fills job->materials. First, since objects refer to them. */
ps_result mesh_read_materials(struct mesh_job *job);

/* Meshes and objects. */
ps_result mesh_read_objects(struct mesh_job *job);

ps_result mesh_read_cameras(struct mesh_job *job);
ps_result mesh_read_lights(struct mesh_job *job);

#endif
