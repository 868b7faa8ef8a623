/* material/principled.case.c: what tests know of the material principled. */
#include "material/material.case.h"

const MaterialCase principled_material = {{
    {.parameters = "\"rgb basecolor\" [.9 .5 .2] \"float metallic\" 0 \"float roughness\" .5",
     .reflected = 1},
    {.parameters = "\"rgb basecolor\" [.9 .5 .2] \"float metallic\" 1 \"float roughness\" .7 "
                   "\"float anisotropy\" .5",
     .reflected = 1},
    {.parameters = "\"float metallic\" 0 \"float roughness\" .6 \"float clearcoat\" 1 "
                   "\"float clearcoatroughness\" .5 \"rgb sheencolor\" [.5 .3 .2] "
                   "\"float sheenroughness\" .4",
     .reflected = 1,
     .one_way = true},
    {.parameters = "\"float metallic\" 0 \"float roughness\" .6 \"float transmission\" .7 "
                   "\"bool thinwalled\" true",
     .one_way = true},
    {.parameters =
         "\"float metallic\" 0 \"float roughness\" .6 \"float diffusetransmission\" .5 "
         "\"rgb diffusetransmissioncolor\" [.3 .5 .9]",
     .one_way = true},
    {.parameters = "\"float metallic\" 0 \"float roughness\" .5 \"float transmission\" .7 "
                   "\"float anisotropy\" .8 \"bool thinwalled\" false",
     .refracts = 1.5},
}};
