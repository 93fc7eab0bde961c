"""Reference points of the assembly and the rigid bodies that follow them."""

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from abaqus.Assembly.Assembly import Assembly
    from abaqus.Model.Model import Model


def reference_point(assembly, name, at):
    # type: (Assembly, str, tuple[float, float, float]) -> None
    """A reference point at a position in mm, in a set of its own."""
    feature = assembly.ReferencePoint(point=at)
    # The repository's keys are the features' numbers, whatever the stub says.
    point = assembly.referencePoints[feature.id]  # pyright: ignore[reportArgumentType]
    assembly.Set(name=name, referencePoints=(point,))


def pin(model, name):
    # type: (Model, str) -> None
    """Makes the set `name` of a solid's nodes, which have no rotations, follow the reference point RP-`name`."""
    sets = model.rootAssembly.sets
    model.RigidBody(name=name, refPointRegion=sets["RP-" + name], pinRegion=sets[name])


def tie(model, name, nodes):
    # type: (Model, str, str) -> None
    """Makes the set `nodes` of a shell's nodes follow the reference point RP-`name` with their rotations."""
    sets = model.rootAssembly.sets
    model.RigidBody(name=name, refPointRegion=sets["RP-" + name], tieRegion=sets[nodes])
