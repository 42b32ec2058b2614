// The arrays of a launcher's geometry.

// An array as a list of rows; none where the geometry has no such array.
export function rowsOf(geometry, name) {
  const { columns, value } = geometry?.[name] ?? { columns: 1, value: [] }, rows = [];
  for (let i = 0; i < value.length; i += columns) rows.push(value.slice(i, i + columns));
  return rows;
}
