/* test/render/agreeing.h: the rows of test_tracers_agree.c. */
{.name = "room", .world = ROOM},
    {.name = "flat curves",
     .lacking = "shape \"curve\"",
     .world = ROOM
     "Shape \"curve\" \"string type\" \"flat\" \"point3 P\" [-.8 .3 .4 -.2 0 .5 .3 .5 .3 .8 .3 .4] \"float width\" .1"},
    {.name = "hair", .lacking = "material \"hair\"", .world = ROOM "Material \"hair\" \"rgb sigma_a\" [3 1 .3] " BALL},
    {.name = "regularization",
     .lacking = "regularization",
     .head = "Integrator \"volpath\" \"bool regularize\" true " CAMERA,
     .world = ROOM "Material \"conductor\" \"float roughness\" .1 " BALL},
