/* import/gltf/draco.h: libdraco, behind functions of C. Only builds with VELO_DRACO have
 * them. */
#ifndef IMPORT_GLTF_DRACO_H
#define IMPORT_GLTF_DRACO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A decoded mesh. Its memory is Draco's own. */
typedef struct vlDraco vlDraco;
/* Null: the bytes are no mesh of Draco's (why: in `reason`), or memory is exhausted. */
vlDraco *vl_draco_open(const uint8_t *data, size_t size, char *reason, size_t reason_size);
void vl_draco_close(vlDraco *mesh);
uint32_t vl_draco_faces(const vlDraco *mesh);
uint32_t vl_draco_points(const vlDraco *mesh);
/* Three per face; each below the number of points. */
void vl_draco_indices(const vlDraco *mesh, uint32_t *indices);
/* The values of an attribute as glTF's component type (5120 to 5126), `components` per point.
 * False: the mesh has no attribute of this id, or its values do not convert. */
bool vl_draco_values(const vlDraco *mesh, uint32_t id, uint32_t type, uint32_t components,
                     void *values);

#ifdef __cplusplus
}
#endif
#endif
