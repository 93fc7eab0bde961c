"""Leaves a model as it was when building fails."""

#: Repositories of a model in the order in which new objects can go: users of others first.
_MODEL = (
    "boundaryConditions",
    "predefinedFields",
    "fieldOutputRequests",
    "historyOutputRequests",
    "constraints",
    "steps",
    "amplitudes",
    "analyticalFields",
    "sketches",
)
_AFTER_ASSEMBLY = ("parts", "sections", "materials")


class Snapshot(object):
    """The names in a model before building."""

    def __init__(self, model):
        self._model = model
        self._before = [(repository, list(repository.keys())) for repository in self._repositories()]

    def _repositories(self):
        model, assembly = self._model, self._model.rootAssembly
        for name in _MODEL:
            yield getattr(model, name)
        # Instances and reference points are features of the assembly.
        for repository in (assembly.sets, assembly.features):
            yield repository
        for name in _AFTER_ASSEMBLY:
            yield getattr(model, name)

    def restore(self):
        """Deletes what is new, latest first."""
        for repository, before in self._before:
            for key in [key for key in reversed(list(repository.keys())) if key not in before]:
                del repository[key]


def existing(model, names):
    """Which of the names the model has already: [(repository, name)]."""
    assembly, found = model.rootAssembly, []
    for kind in sorted(names):
        repository = getattr(assembly if kind in ("instances", "sets") else model, kind)
        found += [(kind, name) for name in names[kind] if name in repository.keys()]
    return found
