/* import/pbrt/meshes.c: mesh files. While statements are executed, only file names and
 * placeholders for the shapes are recorded. At the end all workers read the files, and the
 * shapes replace their placeholders in the order of the statements. Ids and the reported error
 * do not depend on the number of workers. */
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "import/pbrt/builder.h"
#include "import/ply/ply.h"
#include "velo/shape_kinds.h"

typedef struct Job {
  vlMesh mesh;
  vlError error;
  vlResult result;
} Job;

typedef struct Work {
  vlImport *import;
  Job *jobs;
  uint32_t first; /* of import->mesh_files */
} Work;

bool vl_import_note_mesh(vlImport *import, const char *path, vlSource source,
                         const vlShapeDef *def, const vlShapeLink *link) {
  vlScene *scene = import->scene;
  vlMeshFile *file = VL_IMPORT_PUSH(import, &import->mesh_files);
  if (!file)
    return false;
  *file = (vlMeshFile){
      .source = source, .def = *def, .link = *link, .shape = (uint32_t)scene->shapes.count};
  if (!(file->path = vl_import_keep(import, path)) ||
      !vl_scene_copy_source(scene, &file->source) ||
      !vl_scene_copy_source(scene, &file->def.source))
    return false;
  vlShapeDef *slot =
      scene->shapes.count < 0x7fffffff ? VL_PUSH(scene->context, &scene->shapes) : NULL;
  if (!slot)
    return vl_import_fail_memory(import);
  *slot = file->def; /* a placeholder without faces */
  return true;
}

static void read_one(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  const Work *work = user;
  Job *job = &work->jobs[index];
  const vlImport *import = work->import;
  if (vl_task_stopped(import->scene->task, "reading", 0.5)) {
    job->result = vl_fail(&job->error, VL_CANCELLED, "stopped");
    return;
  }
  const vlPlyOptions options = {.task = import->scene->task, .broken = import->permissive};
  job->result = vl_ply_read(import->context, import->mesh_files.items[work->first + index].path,
                            &options, &job->mesh, &job->error);
}

/* Permissive: repairs the mesh; the first one is reported with the mesh file's name. */
static bool repair(vlImport *import, const vlMeshFile *file, const vlShapeDef *def) {
  vlShapeDef named = *def;
  named.source = (vlSource){file->path, 0, 0};
  return !import->permissive || vl_repair_mesh(import->context, &import->repairs, &named) ||
         vl_import_fail_memory(import);
}

/* A file with triangles and patches becomes two shapes without shared arrays: the patches come
 * first and are copied. */
static bool add_mesh(vlImport *import, const vlMeshFile *file, Job *job) {
  vlMesh *mesh = &job->mesh;
  if (job->result != VL_OK) {
    vlSource inside = {job->error.file, job->error.line, job->error.column};
    return vl_import_fail(import, job->result, job->error.file[0] ? inside : file->source, "%s",
                          job->error.message);
  }
  vlShapeDef def = file->def;
  if (file->link.displacement && !vl_mesh_split_quads(import->context, mesh))
    return vl_import_fail_memory(import); /* only triangles can be displaced */
  vl_mesh_to_shape(mesh, &def);
  if (mesh->triangles && mesh->quads) {
    vlShapeDef copy = def;
    copy.kind = VL_SHAPE_BILINEAR;
    copy.faces = (uint32_t)mesh->quads;
    copy.indices = mesh->quad_indices;
    if (!repair(import, file, &copy))
      return false;
    if (!vl_scene_add_shape(import->scene, &copy).index)
      return false;
    vl_free(import->context, mesh->quad_indices);
    mesh->quad_indices = NULL;
  }
  def.kind = VL_SHAPE_TRIANGLES;
  if (!mesh->triangles) {
    def.kind = VL_SHAPE_BILINEAR;
    def.faces = (uint32_t)mesh->quads;
    def.indices = mesh->quad_indices;
  }
  if (!repair(import, file, &def))
    return false;
  *mesh = (vlMesh){0}; /* the arrays have moved, also on failure */
  return vl_scene_adopt_shape(import->scene, &def).index != 0;
}

/* Moves the links of placeholder shapes to the shapes that replaced them: placeholder i became
 * shapes first[i] to first[i + 1] - 1. */
static bool move_links(vlImport *import, const uint32_t *first) {
  size_t n = import->medium_links.count;
  for (size_t i = 0; i < n; i++) {
    vlMediumLink link = import->medium_links.items[i];
    if (link.target != 's')
      continue;
    uint32_t old = link.index, count = first[old + 1] - first[old];
    import->medium_links.items[i].index = first[old];
    if (!count)
      import->medium_links.items[i].target = 0; /* the shape was skipped */
    for (uint32_t k = 1; k < count; k++) {
      vlMediumLink *more = VL_IMPORT_PUSH(import, &import->medium_links);
      if (!more)
        return false;
      *more = link;
      more->index = first[old] + k;
    }
  }
  size_t links = import->links.count;
  for (size_t i = 0; i < links; i++)
    import->links.items[i].shape = first[import->links.items[i].shape];
  VL_EACH_ITEM(const vlMeshFile, file, &import->mesh_files) {
    for (uint32_t k = first[file->shape]; k < first[file->shape + 1]; k++)
      if (!vl_import_link_shape(import, &file->link, k))
        return false;
  }
  return true;
}

/* Files are read in batches, so that the arrays not yet moved stay small compared with the
 * scene. */
enum { RUN = 256 };

static bool place_shapes(vlImport *import, const vlShapeDef *old, size_t count,
                         uint32_t *first) {
  vlScene *scene = import->scene;
  Job *jobs = vl_alloc_array(import->context, RUN, sizeof *jobs);
  if (!jobs)
    return vl_import_fail_memory(import);
  uint32_t next = 0, read = 0, from = 0;
  bool fine = true;
  for (size_t i = 0; i < count && fine; i++) {
    first[i] = (uint32_t)scene->shapes.count;
    if (vl_scene_stopped(scene, 0.5 + 0.5 * (double)i / (double)count))
      fine = false;
    if (next < import->mesh_files.count && import->mesh_files.items[next].shape == i) {
      if (next == read) {
        Work work = {import, jobs, next};
        uint32_t left = (uint32_t)import->mesh_files.count - next;
        from = next;
        read = next + (left < RUN ? left : RUN);
        memset(jobs, 0, RUN * sizeof *jobs);
        vl_parallel_for(import->context, read - from, read_one, &work);
      }
      fine = add_mesh(import, &import->mesh_files.items[next], &jobs[next - from]) ||
             vl_import_recover(import);
      next++;
    } else {
      vlShapeDef *slot = VL_PUSH(scene->context, &scene->shapes);
      if (slot)
        *slot = old[i];
      else
        fine = vl_import_fail_memory(import);
    }
  }
  first[count] = (uint32_t)scene->shapes.count;
  for (uint32_t k = from; k < read; k++)
    vl_mesh_free(import->context, &jobs[k - from].mesh);
  vl_free(import->context, jobs);
  return fine;
}

bool vl_import_read_meshes(vlImport *import) {
  vlScene *scene = import->scene;
  if (!import->mesh_files.count)
    return true;
  size_t count = scene->shapes.count;
  vlShapeDef *old = scene->shapes.items;
  uint32_t *first = vl_alloc_array(import->context, count + 1, sizeof *first);
  if (!first)
    return vl_import_fail_memory(import);
  scene->shapes.items = NULL;
  scene->shapes.count = scene->shapes.capacity = 0;
  bool fine = place_shapes(import, old, count, first) && move_links(import, first);
  VL_FREE(import->context, old, first);
  return fine;
}
