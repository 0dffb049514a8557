"""What simwright writes, in Drake: warnings, inertials, stillness."""

import logging
import pathlib

from pydrake.all import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddMultibodyPlant,
    AddRigidHydroelasticProperties,
    Box,
    CoulombFriction,
    DiagramBuilder,
    LoadModelDirectives,
    ModelInstanceIndex,
    MultibodyPlantConfig,
    Parser,
    ProcessModelDirectives,
    ProximityProperties,
    RigidTransform,
    Simulator,
)

import inertials

# Drake says so of every joint with friction that a URDF has: it has none. SDF's it passes over.
ONLY_WARNING = "does not currently support non-zero joint friction"


# Pa, of a compliant floor half a metre deep: 0.2 GPa/m, as a rubber mat of 2 cm has.
FLOOR_MODULUS = 1e8


class Heard(logging.Handler):
    def __init__(self):
        super().__init__(logging.WARNING)
        self.messages = []
        logging.getLogger("drake").addHandler(self)

    def emit(self, record):
        self.messages.append(record.getMessage())

    def close(self):
        logging.getLogger("drake").removeHandler(self)
        super().close()


def add_ground(plant, rigid):
    properties = ProximityProperties()
    AddContactMaterial(None, None, CoulombFriction(0.8, 0.8), properties)
    if rigid:
        AddRigidHydroelasticProperties(1.0, properties)
    else:
        AddCompliantHydroelasticProperties(1.0, FLOOR_MODULUS, properties)
    plant.RegisterCollisionGeometry(
        plant.world_body(), RigidTransform([0, 0, -0.5]), Box(20, 20, 1), "ground", properties
    )


def watch(load, rigid_ground, seconds=2.0):
    """Loads by `load(parser)`, as a plant is by default; what was heard, the plant, the stillness.
    rigid_ground None: what is loaded has a ground."""
    heard = Heard()
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlant(MultibodyPlantConfig(time_step=1e-3), builder)
    load(Parser(plant))
    heard.close()
    if rigid_ground is not None:
        add_ground(plant, rigid_ground)
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    still = inertials.Stillness()
    simulator.Initialize()
    steps = round(seconds / 0.05)
    for step in range(steps + 1):
        simulator.AdvanceTo(step * 0.05)
        for model in range(2, plant.num_model_instances()):
            for index in plant.GetBodyIndices(ModelInstanceIndex(model)):
                body = plant.get_body(index)
                pose = plant.EvalBodyPoseInWorld(context, body)
                still.see(
                    "%s %s" % (plant.GetModelInstanceName(ModelInstanceIndex(model)), body.name()),
                    pose.translation(),
                    pose.rotation().matrix(),
                )
    return heard.messages, plant, still


def check_asset(folder):
    text, wanted = inertials.of_asset(folder)
    said = {}
    for ending in ("sdf", "urdf"):
        path = str(pathlib.Path(folder) / ("%s.%s" % (text["name"], ending)))
        fixed = text.get("fixed", False)

        def load(parser):
            models = parser.AddModels(path)
            if fixed and ending == "urdf":
                plant = parser.plant()
                root = plant.GetBodyByName(text["links"][0]["name"], models[0])
                plant.WeldFrames(plant.world_frame(), root.body_frame())

        # Joints without friction creep open where a soft floor gives way on one side.
        slides = not fixed and any(j["type"] != "fixed" for j in text.get("joints", []))
        for rigid in (True,) if slides else (True, False):
            heard, plant, still = watch(load, rigid)
            heard = [one for one in heard if not (ending == "urdf" and ONLY_WARNING in one)]
            assert not heard, (path, heard)
            still.require("%s on a %s ground" % (path, "rigid" if rigid else "compliant"))
            said["%s %s" % (ending, "rigid" if rigid else "compliant")] = str(still)
        for name, numbers in wanted.items():
            body = plant.GetBodyByName(name)
            inertia = body.default_spatial_inertia()
            centre = inertia.get_com()
            about = inertia.CalcRotationalInertia().ShiftToCenterOfMass(inertia.get_mass(), centre)
            inertials.require_same(
                (inertia.get_mass(), centre, about.CopyToFullMatrix3()), numbers, (path, name)
            )
    return said


def check_scene(folder):
    folder = pathlib.Path(folder)
    said = {}

    def load_directives(parser):
        parser.package_map().AddPackageXml(str(folder.parent / "package.xml"))
        ProcessModelDirectives(LoadModelDirectives(str(folder / "scene.dmd.yaml")), parser)

    loads = {
        "world.sdf": lambda parser: parser.AddModels(str(folder / "world.sdf")),
        "scene.dmd.yaml": load_directives,
    }
    for name, load in loads.items():
        heard, _, still = watch(load, None)
        assert not heard, (folder, name, heard)
        still.require("%s/%s" % (folder, name))
        said[name] = str(still)
    return said
