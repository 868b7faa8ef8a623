#!/usr/bin/python3
"""The volume of Blender's world, and cameras inside of volumes."""
import run_inside

run_inside.main(__file__)
