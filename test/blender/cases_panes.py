"""Cases of test_panes.py: open surfaces of glass."""
import math

import bmesh
import bpy

from inside import agrees, ball, case, colors, material, new_scene, notes, plane, render


@case
def open_glass_is_a_pane():
    """A plane of glass in a white world is white from both sides (velo's radiance in glass is 2.1 times that in air). Solids, also with
    small holes, refract."""
    for kind in ("ShaderNodeBsdfGlass", "ShaderNodeBsdfPrincipled", "ShaderNodeBsdfRefraction"):
        for turn in (0.0, math.pi):
            scene = new_scene(world=(1, 1, 1))
            made, node = material(kind, IOR=1.45, Roughness=0.0)
            if kind == "ShaderNodeBsdfPrincipled":
                node.inputs["Transmission"].default_value, node.inputs["Base Color"].default_value = 1.0, (1, 1, 1, 1)
            plane(made, 3.0, (0, 0, 0.5)).rotation_euler.x = 1.2 + turn
            image = colors(render(scene))
            assert abs(image - 1).max() < 0.02 or kind == "ShaderNodeBsdfRefraction", (kind, turn, image.min(), image.max())
            agrees(scene)
            assert any("thin pane" in line for line in notes(scene)), notes(scene)
    for holes, is_pane in ((0, False), (20, False), (600, True)):
        scene = new_scene(world=(1, 1, 1))
        mesh = ball(material("ShaderNodeBsdfGlass", IOR=1.45)[0]).data
        edited = bmesh.new()
        edited.from_mesh(mesh)
        edited.faces.ensure_lookup_table()
        bmesh.ops.delete(edited, geom=sorted(edited.faces, key=lambda face: face.calc_center_median().z)[:holes], context="FACES")
        edited.to_mesh(mesh)
        render(scene)
        assert any("thin pane" in line for line in notes(scene)) == is_pane, (holes, notes(scene))


@case
def panes_of_a_mesh_are_found_one_by_one():
    """Four windows of one mesh, whose normals cancel; and a slot of a closed box."""
    scene = new_scene(world=(1, 1, 1))
    made = material("ShaderNodeBsdfGlass", IOR=1.45)[0]
    bpy.ops.mesh.primitive_cube_add(size=2)
    item = bpy.context.object
    item.data.materials.append(made)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.edge_split()
    bpy.ops.object.mode_set(mode="OBJECT")
    render(scene)
    assert not notes(scene), notes(scene)  # split edges do not open it
    for polygon in item.data.polygons:
        for number in polygon.vertices:
            item.data.vertices[number].co += 0.3 * polygon.normal
    render(scene)
    assert any("thin pane" in line for line in notes(scene)), notes(scene)
