#!/usr/bin/python3
"""Textures of velo in Blender: images, nodes that are baked over uv maps and by triangles, normals, the world's image."""
import run_inside

run_inside.main(__file__)
