#!/usr/bin/python3
"""What the camera sees of objects: hidden ones, holdouts, collections that are either."""
import run_inside

run_inside.main(__file__)
