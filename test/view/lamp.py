"""A scene whose best tracer is bidirectional. %s: its integrator, or nothing."""
# A lamp in a tube that is open above: light from the lamps finds the room.
SCENE = '''LookAt 0 1 3.5 0 0.8 0 0 1 0
Camera "perspective" "float fov" [60]
Film "rgb" "integer xresolution" [112] "integer yresolution" [88]
Sampler "zsobol" "integer pixelsamples" [64]
%sWorldBegin
Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
Shape "bilinearmesh" "point3 P" [-4 0 -4  4 0 -4  -4 0 4  4 0 4]
Shape "bilinearmesh" "point3 P" [-4 3 -4  4 3 -4  -4 3 4  4 3 4]
Shape "bilinearmesh" "point3 P" [-4 0 -2  4 0 -2  -4 3 -2  4 3 -2]
AttributeBegin
  Rotate -90 1 0 0
  Shape "cylinder" "float radius" [0.4] "float zmin" [0.3] "float zmax" [1.2]
AttributeEnd
AttributeBegin
  Translate 0 0.8 0
  AreaLightSource "diffuse" "rgb L" [60 60 50]
  Shape "sphere" "float radius" [0.15]
AttributeEnd
'''
