/* lecture: the slides' own program in C, a small ray caster from World and Camera to the image. It uses only C's
 * library. C has no classes: a method Class::name is a function Class_name, a virtual method is a pointer to a
 * function, and a subclass is a struct whose first member is the struct of its base class.
 *
 *   lecture [NAME=VALUE...] >IMAGE.ppm          for example: lecture d=800 roll=10 >image.ppm
 *   eye=300,400,500 lookat=0,0,-50 up=0,1,0 d=400 zoom=1 s=1 roll=0 exposure=1      the camera, as on the slides
 *   size=400x300 n=3      pixels; n x n samples for each            world=build      or still, spheres
 *   camera=pinhole        or orthographic, or axis: World::render_perspective (of eye, only z counts)
 *   tracer=raycast        or print: each ray `ox,oy,oz,dx,dy,dz` instead of an image
 * To compile it: cc -std=c17 lecture.c -lm -o lecture */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  double x, y, z;
} Vector3D;
typedef Vector3D Point3D;
typedef Vector3D RGBColor; /* red, green, blue */
typedef struct {
  double x, y;
} Point2D;
typedef struct {
  Point3D o;  /* origin */
  Vector3D d; /* direction, of length 1 */
} Ray;

static Vector3D add(Vector3D a, Vector3D b) {
  return (Vector3D){a.x + b.x, a.y + b.y, a.z + b.z};
}
static Vector3D mul(double k, Vector3D a) {
  return (Vector3D){k * a.x, k * a.y, k * a.z};
}
static Vector3D sub(Vector3D a, Vector3D b) {
  return (Vector3D){a.x - b.x, a.y - b.y, a.z - b.z};
}
static double dot(Vector3D a, Vector3D b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static Vector3D cross(Vector3D a, Vector3D b) { /* the slides' a ^ b */
  return (Vector3D){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static Vector3D normalize(Vector3D a) {
  return mul(1 / sqrt(dot(a, a)), a);
}

/* ---- Sampler and ViewPlane ---- */
typedef struct {
  int n, count; /* n x n samples for each pixel; samples given so far */
} Sampler;

static Point2D Sampler_sample_unit_square(Sampler *sampler) { /* the centres of n x n small squares, in turn */
  int n = sampler->n, j = sampler->count++ % (n * n);
  return (Point2D){(j % n + 0.5) / n, (j / n + 0.5) / n};
}
typedef struct {
  int hres, vres; /* resolution of the window */
  double s;       /* size of a pixel */
  int num_samples;
  Sampler *sampler_ptr;
} ViewPlane;

/* ---- GeometricObject and its subclasses: a sphere, and a horizontal plane with a pattern of squares ---- */
typedef struct {
  Vector3D normal;
  RGBColor color;
} ShadeRec; /* what there is to know about a hit */
typedef struct GeometricObject {
  const char *world;                                                          /* the world that it belongs to */
  double (*hit)(const struct GeometricObject *object, Ray ray, ShadeRec *sr); /* distance; INFINITY: no hit */
  Point3D p;   /* Sphere: its centre; Plane: one of its points */
  double size; /* Sphere: its radius; Plane: the side of a square */
  RGBColor color;
} GeometricObject;
static double Sphere_hit(const GeometricObject *sphere, Ray ray, ShadeRec *sr) {
  Vector3D oc = sub(ray.o, sphere->p); /* |oc + t d| = radius is a quadratic equation for t */
  double b = dot(oc, ray.d), disc = b * b - dot(oc, oc) + sphere->size * sphere->size;
  if (disc < 0) return INFINITY;
  double t = -b - sqrt(disc) > 1e-9 ? -b - sqrt(disc) : -b + sqrt(disc);
  *sr = (ShadeRec){normalize(add(oc, mul(t, ray.d))), sphere->color};
  return t > 1e-9 ? t : INFINITY;
}
static double Plane_hit(const GeometricObject *plane, Ray ray, ShadeRec *sr) {
  double t = (plane->p.y - ray.o.y) / ray.d.y;
  if (!(t > 1e-9)) return INFINITY;
  Point3D p = add(ray.o, mul(t, ray.d));
  int odd = fmod(floor(p.x / plane->size) + floor(p.z / plane->size), 2) != 0;
  *sr = (ShadeRec){{0, 1, 0}, mul(odd ? 0.8 : 1, plane->color)};
  return t;
}

/* ---- World, and Tracer: the colour that a ray sees ---- */
typedef struct World {
  ViewPlane vp;
  RGBColor (*trace_ray)(const struct World *world, Ray ray); /* the slides' tracer_ptr->trace_ray */
  struct Camera *camera_ptr;
  RGBColor background_color;
  GeometricObject objects[32];
  int num_objects;
  unsigned char *pixels; /* red, green, blue; rows from the top */
} World;

/* The first object that the ray hits, lit from the eye: its colour times the cosine between ray and normal. */
static RGBColor RayCast_trace_ray(const World *world, Ray ray) {
  RGBColor L = world->background_color;
  double tmin = INFINITY;
  for (int i = 0; i < world->num_objects; i++) {
    ShadeRec sr;
    double t = world->objects[i].hit(&world->objects[i], ray, &sr);
    if (t < tmin) tmin = t, L = mul(fabs(dot(sr.normal, ray.d)), sr.color);
  }
  return L;
}
static RGBColor Print_trace_ray(const World *world, Ray ray) {
  printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z);
  return world->background_color;
}
static void World_display_pixel(World *world, int r, int c, RGBColor L) {
  unsigned char *pixel = world->pixels + 3 * ((world->vp.vres - 1 - r) * world->vp.hres + c); /* r counts upwards */
  const double rgb[] = {L.x, L.y, L.z};
  for (int k = 0; k < 3; k++) pixel[k] = (unsigned char)(255 * pow(fmin(fmax(rgb[k], 0), 1), 1 / 2.2) + 0.5);
}

/* ---- Camera and its subclasses ---- */
typedef struct Camera {
  void (*render_scene)(const struct Camera *camera, World *w); /* virtual */
  Point3D eye, lookat;
  Vector3D u, v, w; /* orthonormal basis */
  Vector3D up;
  double exposure_time, roll; /* roll: degrees, the camera turns clockwise */
} Camera;

static void Camera_compute_uvw(Camera *camera) {
  camera->w = normalize(sub(camera->eye, camera->lookat));
  Vector3D u = normalize(cross(camera->up, camera->w)), v = cross(camera->w, u);
  double a = camera->roll * acos(-1) / 180; /* degrees to radians; the slides leave the roll to the reader */
  camera->u = add(mul(cos(a), u), mul(-sin(a), v));
  camera->v = add(mul(sin(a), u), mul(cos(a), v));
}

typedef struct {
  Camera base;
  double d;    /* view plane distance */
  double zoom; /* zoom factor */
} Pinhole;
static Vector3D Pinhole_get_direction(const Pinhole *pinhole, Point2D p) {
  const Camera *camera = &pinhole->base;
  return normalize(add(add(mul(p.x, camera->u), mul(p.y, camera->v)), mul(-pinhole->d, camera->w)));
}

static void Pinhole_render_scene(const Camera *camera, World *w) {
  const Pinhole *pinhole = (const Pinhole *)camera;
  ViewPlane vp = w->vp;
  Ray ray = {.o = camera->eye};
  vp.s /= pinhole->zoom;
  for (int r = 0; r < vp.vres; r++)     /* up */
    for (int c = 0; c < vp.hres; c++) { /* across */
      RGBColor L = {0, 0, 0};
      for (int j = 0; j < vp.num_samples; j++) { /* across pixel */
        Point2D sp = Sampler_sample_unit_square(vp.sampler_ptr);
        Point2D pp = {vp.s * (c - 0.5 * vp.hres + sp.x), vp.s * (r - 0.5 * vp.vres + sp.y)};
        ray.d = Pinhole_get_direction(pinhole, pp);
        L = add(L, w->trace_ray(w, ray));
      }
      World_display_pixel(w, r, c, mul(camera->exposure_time / vp.num_samples, L));
    }
}

/* Parallel projectors: the direction is fixed, and the origin moves over the view plane through the eye. */
static void Orthographic_render_scene(const Camera *camera, World *w) {
  ViewPlane vp = w->vp;
  for (int r = 0; r < vp.vres; r++)
    for (int c = 0; c < vp.hres; c++) {
      double x = vp.s * (c - vp.hres / 2.0 + 0.5), y = vp.s * (r - vp.vres / 2.0 + 0.5);
      Point3D o = add(camera->eye, add(mul(x, camera->u), mul(y, camera->v)));
      World_display_pixel(w, r, c, w->trace_ray(w, (Ray){o, mul(-1, camera->w)}));
    }
}

/* The lecture's first loop, for an eye on the z axis that looks along -z. */
static void World_render_perspective(const Camera *camera, World *w) {
  ViewPlane vp = w->vp;
  Ray ray = {.o = {0, 0, camera->eye.z}};
  double zw = -((const Pinhole *)camera)->d;
  for (int r = 0; r < vp.vres; r++)     /* up */
    for (int c = 0; c < vp.hres; c++) { /* across; the slide has <=, one column too many */
      ray.d = normalize((Vector3D){vp.s * (c - vp.hres / 2.0 + 0.5), vp.s * (r - vp.vres / 2.0 + 0.5), zw});
      World_display_pixel(w, r, c, w->trace_ray(w, ray));
    }
}

/* ---- World::build: the objects, and the camera of the slide unless the arguments change it ---- */
static const GeometricObject objects[] = {
    {"build", Sphere_hit, {-20, 0, -70}, 100, {0.62, 0.2, 0.11}},
    {"build", Sphere_hit, {125, -40, 45}, 60, {0.04, 0.11, 0.32}},
    {"build", Sphere_hit, {5, -58, 100}, 42, {0.8, 0.6, 0.2}},
    {"build", Sphere_hit, {88, -78, 148}, 22, {0.68, 0.46, 0.06}},
    {"build", Sphere_hit, {-82, -72, 112}, 28, {0.1, 0.32, 0.2}},
    {"build", Plane_hit, {0, -100, 0}, 100, {0.58, 0.56, 0.52}},
    {"still", Sphere_hit, {-6, -1, -6}, 9, {0.62, 0.2, 0.11}},
    {"still", Sphere_hit, {7, -5, 4}, 5, {0.04, 0.11, 0.32}},
    {"still", Sphere_hit, {-5, -7, 9}, 3, {0.8, 0.6, 0.2}},
    {"still", Plane_hit, {0, -10, 0}, 10, {0.58, 0.56, 0.52}},
};
static Sampler sampler = {.n = 3};
static World world = {.vp = {400, 300, 1, 9, &sampler}, .trace_ray = RayCast_trace_ray};
static Pinhole pinhole = {
    {Pinhole_render_scene, {300, 400, 500}, {0, 0, -50}, .up = {0, 1, 0}, .exposure_time = 1}, 400, 1};
static const char *world_name = "build";

static void World_build(void) {
  for (size_t i = 0; i < sizeof objects / sizeof objects[0]; i++)
    if (strcmp(objects[i].world, world_name) == 0) world.objects[world.num_objects++] = objects[i];
  for (int i = 0; i < 25 && strcmp(world_name, "spheres") == 0; i++) /* 5 x 5 equal spheres in the plane z = 0 */
    world.objects[world.num_objects++] =
        (GeometricObject){"spheres", Sphere_hit, {1.3 * (i % 5 - 2), 1.3 * (i / 5 - 2), 0}, 0.6, {0.62, 0.4, 0.12}};
  Camera_compute_uvw(&pinhole.base);
  world.camera_ptr = &pinhole.base;
}
static int read_argument(const char *a) { /* into the structs above; 0: there is no such argument */
  Camera *p = &pinhole.base;
  if (strncmp(a, "world=", 6) == 0) return world_name = a + 6, 1;
  if (strcmp(a, "camera=pinhole") == 0 || strcmp(a, "tracer=raycast") == 0) return 1; /* as above */
  if (strcmp(a, "camera=orthographic") == 0) return p->render_scene = Orthographic_render_scene, 1;
  if (strcmp(a, "camera=axis") == 0) return p->render_scene = World_render_perspective, 1;
  if (strcmp(a, "tracer=print") == 0) return world.trace_ray = Print_trace_ray, 1;
  return sscanf(a, "eye=%lf,%lf,%lf", &p->eye.x, &p->eye.y, &p->eye.z) == 3 ||
         sscanf(a, "lookat=%lf,%lf,%lf", &p->lookat.x, &p->lookat.y, &p->lookat.z) == 3 ||
         sscanf(a, "up=%lf,%lf,%lf", &p->up.x, &p->up.y, &p->up.z) == 3 || sscanf(a, "d=%lf", &pinhole.d) == 1 ||
         sscanf(a, "zoom=%lf", &pinhole.zoom) == 1 || sscanf(a, "roll=%lf", &p->roll) == 1 ||
         sscanf(a, "exposure=%lf", &p->exposure_time) == 1 || sscanf(a, "s=%lf", &world.vp.s) == 1 ||
         sscanf(a, "size=%dx%d", &world.vp.hres, &world.vp.vres) == 2 || sscanf(a, "n=%d", &sampler.n) == 1;
}

int main(int argc, char **argv) {
  for (int i = 1; i < argc; i++)
    if (!read_argument(argv[i])) return fprintf(stderr, "lecture: unknown argument %s\n", argv[i]), 2;
  int hres = world.vp.hres, vres = world.vp.vres, n = sampler.n;
  World_build();
  if (hres < 1 || hres > 9999 || vres < 1 || vres > 9999 || n < 1 || n > 99 || world.num_objects == 0)
    return fprintf(stderr, "lecture: size is 1x1 to 9999x9999, n 1 to 99, world build, still or spheres\n"), 2;
  if (!(dot(pinhole.base.u, pinhole.base.u) > 0)) return fprintf(stderr, "lecture: no direction to look in\n"), 2;
  world.vp.num_samples = n * n;
  if (!(world.pixels = malloc(3 * (size_t)(hres * vres)))) return fputs("lecture: out of memory\n", stderr), 1;
  world.camera_ptr->render_scene(world.camera_ptr, &world);
  if (world.trace_ray == Print_trace_ray) return 0;
  printf("P6 %d %d 255\n", hres, vres);
  return fwrite(world.pixels, 3, (size_t)(hres * vres), stdout) == (size_t)(hres * vres) && fflush(stdout) == 0 ? 0 : 5;
}
