"""The keywords of calls that take many, for completion and for checks of types. They are the rows of the library's tables; a test
compares them, and tools/check_rows --fix adds what is missing. All are optional: what is not given has its default."""
from __future__ import annotations

import inspect
from typing import Any, Callable, TypedDict

# Members of the library's structs that other keywords set: a mesh's normals those of its parts, an array its size.
APART = frozenset(("data_size", "lamp_size", "wrap_t_given", "encoding_given", "st_from_uv_given", "use_reflectance", "nx", "ny", "nz", "from", "more_uvs"))


class Settings(TypedDict, total=False):
    """Of renders: the members of vlRenderDef, vlFilmDef, vlBuildDef and vlDevelopDef."""
    accelerator: Any
    ao_cosine: Any
    ao_distance: Any
    bits: Any
    buckets: Any
    centred: Any
    color: Any
    errors: Any
    exposure: Any
    filter: Any
    filter_b: Any
    filter_c: Any
    filter_radius_x: Any
    filter_radius_y: Any
    filter_sigma: Any
    filter_tau: Any
    first_sample: Any
    imitate_pbrt: Any
    lambda_max: Any
    lambda_min: Any
    light_paths: Any
    light_sampler: Any
    max_component: Any
    max_depth: Any
    max_diffuse_depth: Any
    max_glossy_depth: Any
    max_transmission_depth: Any
    max_volume_depth: Any
    merge_radius: Any
    noise: Any
    noise_exposure: Any
    noise_scale: Any
    noise_view: Any
    pass_rows: Any
    priority: Any
    regularize: Any
    same_wavelengths: Any
    sampler: Any
    seed: Any
    sensor: Any
    sequence: Any
    share_samples: Any
    sharp_textures: Any
    space: Any
    spp: Any
    time_limit: Any
    tracer: Any
    transparent: Any
    white_balance: Any


class Write(TypedDict, total=False):
    """Of image files: the members of vlWriteDef."""
    compression: Any
    half: Any
    quality: Any


class Load(TypedDict, total=False):
    """Of files that are read: the members of vlLoadDef."""
    animation: Any
    camera: Any
    permissive: Any
    scene: Any
    scene_unit: Any
    search_path: Any
    strict: Any
    time: Any
    time_close: Any
    variant: Any


class Complete(TypedDict, total=False):
    """Of what completes a file: the members of vlCompleteDef."""
    azimuth: Any
    backdrop: Any
    both_sides: Any
    elevation: Any
    environment: Any
    find_up: Any
    framing: Any
    front: Any
    ground: Any
    ground_middle: Any
    ground_radius: Any
    height: Any
    open_walls: Any
    reframe: Any
    rotation: Any
    strength: Any
    up: Any
    walls_from: Any
    width: Any


class Cameras(TypedDict, total=False):
    """Of cameras: the members of vlCameraDef, and further ones (velo.Camera)."""
    K: Any
    alpha: Any
    aperture: Any
    beta: Any
    blades: Any
    camera_from_world: Any
    colmap: Any
    convergence: Any
    cx: Any
    cy: Any
    distortion: Any
    distortion_coefficients: Any
    exposure_time: Any
    eye: Any
    eye_close: Any
    f_number: Any
    far_plane: Any
    focal_mm: Any
    focus_distance: Any
    focus_pixel: Any
    focus_point: Any
    fov: Any
    fov_axis: Any
    fx: Any
    fy: Any
    interocular: Any
    iso: Any
    lens_radius: Any
    lens_tilt_x: Any
    lens_tilt_y: Any
    lookat: Any
    lookat_close: Any
    max_angle: Any
    mode: Any
    near_plane: Any
    omega: Any
    own: Any
    panini: Any
    pixel_size: Any
    pose_times: Any
    projection: Any
    ratio: Any
    readout: Any
    readout_direction: Any
    roll: Any
    roll_close: Any
    rotation: Any
    screen_max_x: Any
    screen_max_y: Any
    screen_min_x: Any
    screen_min_y: Any
    seconds: Any
    sensor_width_mm: Any
    shape: Any
    shutter: Any
    shutter_at: Any
    shutter_close: Any
    shutter_open: Any
    skew: Any
    stereo_eye: Any
    stereo_mode: Any
    tilt_x: Any
    tilt_y: Any
    unit_mm: Any
    up: Any
    up_close: Any
    view_distance: Any
    vignetting: Any
    world_from_camera: Any
    world_from_camera_close: Any
    xi: Any
    zoom: Any


class Textures(TypedDict, total=False):
    """Of textures of all kinds."""
    amount: Any
    bias: Any
    channel: Any
    colors: Any
    cutoff: Any
    data: Any
    dimension: Any
    direction: Any
    du: Any
    dv: Any
    encoding: Any
    filter: Any
    float_a: Any
    float_b: Any
    float_c: Any
    float_d: Any
    gamma: Any
    image: Any
    invert: Any
    mapping: Any
    name: Any
    octaves: Any
    omega: Any
    path: Any
    planar_v1: Any
    planar_v2: Any
    range: Any
    scale: Any
    space: Any
    spectrum: Any
    spectrum_a: Any
    spectrum_b: Any
    spectrum_c: Any
    spectrum_d: Any
    st_from_uv: Any
    su: Any
    sv: Any
    texture_from_world: Any
    tint: Any
    uv_set: Any
    variation: Any
    wrap: Any
    wrap_t: Any


class Materials(TypedDict, total=False):
    """Of materials of all kinds."""
    albedo: Any
    alpha: Any
    amount: Any
    anisotropy: Any
    anisotropy_rotation: Any
    beta_m: Any
    beta_n: Any
    clearcoat: Any
    clearcoat_normal: Any
    clearcoat_normal_scale: Any
    clearcoat_roughness: Any
    coat_eta: Any
    coat_u_roughness: Any
    coat_v_roughness: Any
    color: Any
    conserve_energy: Any
    diffuse_transmission: Any
    diffuse_transmission_color: Any
    dispersion: Any
    displacement: Any
    eta: Any
    eumelanin: Any
    from_reflectance: Any
    g: Any
    iridescence: Any
    iridescence_ior: Any
    iridescence_thickness: Any
    k: Any
    materials: Any
    max_depth: Any
    measured: Any
    metallic: Any
    mfp: Any
    name: Any
    normal: Any
    normal_map: Any
    normal_scale: Any
    pheomelanin: Any
    reflectance: Any
    remap_roughness: Any
    roughness: Any
    samples: Any
    scale: Any
    sheen_color: Any
    sheen_roughness: Any
    sigma_a: Any
    sigma_s: Any
    specular: Any
    specular_color: Any
    thickness: Any
    thin_walled: Any
    transmission: Any
    transmittance: Any
    u_roughness: Any
    v_roughness: Any


class Media(TypedDict, total=False):
    """Of media of all kinds."""
    cloud_density: Any
    density: Any
    emission: Any
    emission_scale: Any
    emission_scales: Any
    frequency: Any
    g: Any
    grid: Any
    high: Any
    low: Any
    name: Any
    path: Any
    pose: Any
    rgb_a: Any
    rgb_absorption: Any
    rgb_emission: Any
    rgb_s: Any
    scale: Any
    sigma_a: Any
    sigma_s: Any
    temperature: Any
    temperature_grid: Any
    temperature_offset: Any
    temperature_scale: Any
    transform: Any
    wispiness: Any


class Emission(TypedDict, total=False):
    """Of emissions."""
    image: Any
    power: Any
    radiance: Any
    radiant_power: Any
    scale: Any
    spread: Any
    texture: Any
    two_sided: Any


class Lights(TypedDict, total=False):
    """Of lights of all kinds."""
    color: Any
    cone_angle: Any
    cone_delta: Any
    cone_squared: Any
    fov: Any
    from_: Any
    illuminance: Any
    image: Any
    irradiance: Any
    lamp_data: Any
    medium: Any
    path: Any
    portal: Any
    pose: Any
    position: Any
    power: Any
    radiant_intensity: Any
    radiant_power: Any
    scale: Any
    space: Any
    to: Any
    transform: Any


class AllShapes(TypedDict, total=False):
    """Of shapes of all kinds."""
    alpha: Any
    backdrop: Any
    emission: Any
    group: Any
    hidden_from_camera: Any
    inside: Any
    material: Any
    name: Any
    outside: Any
    pose: Any
    reverse_orientation: Any
    transform: Any


class Quadrics(AllShapes, total=False):
    """Of spheres, disks and cylinders by their places."""
    phi_max: Any


class Meshes(AllShapes, total=False):
    """Of meshes."""
    colors: Any
    displacement: Any
    edge_length: Any
    normals: Any
    normals_close: Any
    one_sided: Any
    positions_close: Any
    tangent_signs: Any
    tangents: Any
    times: Any
    uvs: Any
    uvs_1: Any
    uvs_2: Any
    uvs_3: Any


class Shapes(Meshes, total=False):
    """Of shapes, whatever their kind."""
    centers: Any
    curve: Any
    height: Any
    indices: Any
    inner_radius: Any
    phi_max: Any
    positions: Any
    radii: Any
    radius: Any
    split_depth: Any
    widths: Any
    z_max: Any
    z_min: Any


class Opening(Load, Complete):
    """Of velo.load."""


class Anything(Textures, Materials, Media, Emission, Lights, Shapes):  # type: ignore[misc]
    """Of objects of any family that are changed. Families share words, all of which are Any."""


def show(function: Callable[..., Any], *groups: type) -> None:
    """Gives a function a signature with each keyword of these groups, for editors that ask a running Python. The default ... is
    that of the library."""
    signature = inspect.signature(function)
    known = list(signature.parameters.values())
    plain = [parameter for parameter in known if parameter.kind is not inspect.Parameter.VAR_KEYWORD]
    words = {name for group in groups for base in group.__mro__ for name in getattr(base, "__annotations__", {})}
    words -= set(signature.parameters)
    more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=..., annotation="Any") for name in sorted(words)]
    rest = [parameter for parameter in known if parameter.kind is inspect.Parameter.VAR_KEYWORD]
    setattr(function, "__signature__", signature.replace(parameters=plain + more + rest))
