#!/usr/bin/python3
"""Objects of velo in Blender: points, displacement, what materials ask of objects, suns, tiled images, Fresnel nodes."""
import run_inside

run_inside.main(__file__)
