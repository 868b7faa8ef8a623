/* material/interface.case.c: what tests know of the material interface. */
#include "material/material.case.h"

const MaterialCase interface_material = {{{.parameters = ""}}};
