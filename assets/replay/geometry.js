// The arrays of a launcher's geometry.

// An array as a list of rows; none where the geometry has no such array.
export function rowsOf(geometry, name) {
  const { columns, value } = geometry?.[name] ?? { columns: 1, value: [] }, rows = [];
  for (let i = 0; i < value.length; i += columns) rows.push(value.slice(i, i + columns));
  return rows;
}

// Where the hinges of a vehicle's platforms are, each in the axes of the body below; none of a base without them.
// Without an azimuth platform the elevation platform is drawn on one that does not turn.
export function hingesOf(rows) {
  const [azimuth] = rows("azimuth.hinge"), [elevation] = rows("elevation.hinge"), drop = 0.3; // [m]
  if (azimuth || !elevation) return [azimuth, elevation];
  return [[elevation[0], elevation[1] - drop, elevation[2]], [0, drop, 0]];
}
