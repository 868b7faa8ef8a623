/* film_halves: a film in two halves: each has half of the samples, as if two machines had rendered them; merged they
 * have the bytes of one render of all samples. The film files are IMAGE.1.film, IMAGE.2.film and IMAGE.film.
 *
 *   film_halves SCENE IMAGE
 *   build/release/bin/example_film_halves examples/corner.pbrt examples/film_halves.jpg
 */
#include "example.h"

int main(int count, char **arguments) {
  Example e = example_open(count, arguments, NULL);
  char names[2][4096], whole[4096];
  uint32_t spp = e.defs->render.spp;
  for (uint32_t half = 0; half < 2; half++) {
    snprintf(names[half], sizeof names[half], "%s.%u.film", arguments[2], half + 1);
    e.defs->render.first_sample = half * spp / 2;
    e.defs->render.spp = (half + 1) * spp / 2;
    example_render(&e);
    example_must(&e, vl_film_write(e.film, NULL, names[half], &e.error), names[half]);
  }
  const char *const paths[2] = {names[0], names[1]};
  snprintf(whole, sizeof whole, "%s.film", arguments[2]);
  example_must(&e, vl_film_merge(e.context, paths, 2, NULL, whole, &e.error), whole);
  vl_film_destroy(e.film);
  example_must(&e, vl_film_read(e.context, whole, false, &e.film, &e.error), whole);
  example_write(&e, arguments[2]);
  return example_close(&e);
}
