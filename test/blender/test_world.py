#!/usr/bin/python3
"""Skies of velo in Blender, which Cycles renders to an image once."""
import run_inside

run_inside.main(__file__)
