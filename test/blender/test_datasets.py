#!/usr/bin/python3
"""Data sets that velo writes in Blender: poses, masks, depths and models against Blender's own and Cycles'."""
import run_inside

run_inside.main(__file__)
