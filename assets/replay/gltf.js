// The scene as glTF 2.0 (ISO/IEC 12113): what is seen at an instant, each body with its matrix and its colours, in one
// file that holds its numbers as base64. Metres, y upwards, as launchdyn's own axes.
const FLOAT = 5126, UNSIGNED = 5125, VERTICES = 34962, INDICES = 34963, TRIANGLES = 4, LINES = 1, LINE_STRIP = 3, LINE_LOOP = 2;

// Collects arrays into one buffer; each becomes a view with an accessor.
class Store {
  constructor() {
    this.parts = [];
    this.bytes = 0;
    this.views = [];
    this.accessors = [];
    this.known = new Map();
  }
  add(attribute, type, target) {
    if (this.known.has(attribute)) return this.known.get(attribute);
    const { array, count, itemSize } = attribute, component = target === INDICES ? UNSIGNED : FLOAT;
    const numbers = component === FLOAT ? new Float32Array(array) : new Uint32Array(array);
    this.views.push({ buffer: 0, byteOffset: this.bytes, byteLength: numbers.byteLength, target });
    const accessor = { bufferView: this.views.length - 1, componentType: component, count, type };
    if (type === "VEC3" && target === VERTICES) Object.assign(accessor, extremes(numbers, itemSize));
    this.accessors.push(accessor);
    this.parts.push(new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength));
    this.bytes += numbers.byteLength;
    this.known.set(attribute, this.accessors.length - 1);
    return this.accessors.length - 1;
  }
  base64() {
    const whole = new Uint8Array(this.bytes);
    let at = 0, text = "";
    for (const part of this.parts) { whole.set(part, at); at += part.length; }
    for (let i = 0; i < at; i += 3072) text += btoa(String.fromCharCode(...whole.subarray(i, i + 3072))); // whole threes
    return text;
  }
}

function extremes(numbers, size) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  numbers.forEach((v, i) => {
    min[i % size] = Math.min(min[i % size], v);
    max[i % size] = Math.max(max[i % size], v);
  });
  return { min, max };
}

// Colours of glTF are linear, as three's are.
function materialOf({ color, opacity, transparent, emissive, vertexColors }, lines) {
  const rgb = ({ r, g, b }) => [r, g, b];
  return {
    pbrMetallicRoughness: { baseColorFactor: [...(vertexColors ? [1, 1, 1] : rgb(color)), transparent ? opacity : 1], metallicFactor: 0, roughnessFactor: 1 },
    doubleSided: true, ...(transparent ? { alphaMode: "BLEND" } : {}), ...(emissive && !lines ? { emissiveFactor: rgb(emissive) } : {}),
  };
}

const modeOf = (object) => (object.isMesh ? TRIANGLES : object.isLineLoop ? LINE_LOOP : object.isLineSegments ? LINES : LINE_STRIP);

// `seen`: whether an object is to be written; `scene`: with matrices that are up to date.
export function gltfOf(scene, seen, generator) {
  const store = new Store(), materials = [], meshes = [], nodes = [], known = new Map();
  const visit = (object) => {
    if (!object.visible || !seen(object)) return;
    const { geometry } = object;
    if ((object.isMesh || object.isLine) && !geometry.isInstancedBufferGeometry && geometry.attributes.position.count > 0) {
      const { position, normal, color } = geometry.attributes, lines = !object.isMesh;
      if (!known.has(object.material)) known.set(object.material, materials.push(materialOf(object.material, lines)) - 1);
      const attributes = { POSITION: store.add(position, "VEC3", VERTICES) };
      if (normal && !lines) attributes.NORMAL = store.add(normal, "VEC3", VERTICES);
      if (color) attributes.COLOR_0 = store.add(color, "VEC3", VERTICES);
      const primitive = { attributes, material: known.get(object.material), mode: modeOf(object) };
      if (geometry.index) primitive.indices = store.add(geometry.index, "SCALAR", INDICES);
      nodes.push({ mesh: meshes.push({ primitives: [primitive] }) - 1, matrix: object.matrixWorld.toArray() });
    }
    object.children.forEach(visit);
  };
  visit(scene);
  return {
    asset: { version: "2.0", generator }, scene: 0, scenes: [{ nodes: nodes.map((_, i) => i) }], nodes, meshes, materials,
    accessors: store.accessors, bufferViews: store.views,
    buffers: [{ byteLength: store.bytes, uri: `data:application/octet-stream;base64,${store.base64()}` }],
  };
}
