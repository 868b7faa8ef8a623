"""indices.py: the passes of object and material indices, from velo's channels of ids."""
import numpy


class Indices:
    """The pass indices of what velo's ids stand for. export: export.Export."""

    def __init__(self, export):
        self._export, self._tables = export, {}

    def layer(self, name, rows):
        """height x width: IndexOB or IndexMA of passes.Rows."""
        if name == "IndexMA":
            return self._look_up("id.material", rows)
        return numpy.where(rows["id.instance"] > 0, self._look_up("id.instance", rows), self._look_up("id.object", rows))

    def _look_up(self, channel, rows):
        """The indices of a channel's ids; 0 where there is none."""
        if channel not in self._tables:
            self._tables[channel] = numpy.array([0, *self._known(channel)], dtype=float)
        table, ids = self._tables[channel], rows[channel].astype(int)
        return numpy.where(ids < len(table), table[numpy.minimum(ids, len(table) - 1)], 0)

    def _known(self, channel):
        """The indices of ids 1, 2, ..."""
        export = self._export
        if channel == "id.material":
            return [export.material_indices.get(entry.get("name"), 0) for entry in export.scene.world().ids("material")]
        owners = export.instances if channel == "id.instance" else export.shapes
        return [0 if placed is None else placed.pass_index for placed in owners]
