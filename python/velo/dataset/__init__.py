"""Annotated datasets of synthetic images: from a seed and a declarative recipe to BOP, COCO, nerfstudio or plain EXR.

    from velo import dataset

    recipe = dataset.Recipe(
        seed=7, frames=200, resolution=(640, 480), spp=16,
        models=[dataset.Model("mug.glb"), dataset.Model("duck.glb", count=(1, 3))],
        placing=dataset.OnSurface(size=(0.8, 0.8)),
        cameras=[dataset.Around(distance=(0.8, 1.4), elevation=(25, 70), fov=50)],
    )
    dataset.generate(recipe, "out", writers=["bop", "coco"])

Each frame depends on the recipe and its own number only: frame 4711 made alone has the same bits. docs/datasets.md is the
guide."""
from velo.dataset.flow import Flow, read_flow, write_flow
from velo.dataset.keypoints import Keypoints, project_keypoints
from velo.dataset.generate import generate, make_writers
from velo.dataset.random import Random
from velo.dataset.recipe import (Around, Distractors, Environment, Fixed, Ground, InVolume, Lights, Materials, Model,
                                 OnScene, OnSurface, Poses, Recipe, Rig, Sensor, Trajectory, read_recipe, recipe_from)
from velo.dataset.cameras import View
from velo.dataset.stage import Frame, Instance, Plan, Stage

__all__ = ["Around", "Distractors", "Environment", "Fixed", "Flow", "Frame", "Ground", "InVolume", "Instance", "Keypoints", "Lights",
           "Materials", "Model", "OnScene", "OnSurface", "Plan", "Poses", "Random", "Recipe", "Rig", "Sensor", "Stage", "Trajectory", "View",
           "generate", "make_writers", "project_keypoints", "read_flow", "read_recipe", "recipe_from", "write_flow"]
