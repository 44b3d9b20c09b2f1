// Records how three.js evaluates the files of ../fixtures, and some corners of fox.glb where that is beside the checkout.
//
// A record is JSON: clips, each at so many frames a second, at 0, 1/fps, ... and its end; in each frame the positions in the world
// by the number of the node. Evaluated as three.js draws: getVertexPosition (morph targets, skin), then the matrix of the mesh.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { AnimationMixer, LoopOnce, REVISION, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

globalThis.ProgressEvent ??= class extends Event {}; // a browser's, which FileLoader of three.js wants
const folder = new URL('../fixtures/', import.meta.url);

// The JSON of a file with its bytes within, and nothing that needs a browser.
function plain(url) {
  const file = readFileSync(url);
  let json, bytes;
  if (file.toString('latin1', 0, 4) === 'glTF') {
    const length = file.readUInt32LE(12);
    json = JSON.parse(file.toString('utf8', 20, 20 + length));
    bytes = file.subarray(20 + length + 8);
  } else {
    json = JSON.parse(file.toString('utf8'));
    const { uri } = json.buffers[0];
    bytes = uri.startsWith('data:') ? null : readFileSync(new URL(uri, url));
  }
  if (bytes) json.buffers[0].uri = `data:application/octet-stream;base64,${bytes.toString('base64')}`;
  for (const name of ['images', 'textures', 'samplers', 'materials']) delete json[name];
  json.nodes.forEach((node, number) => { node.extras = { node: number }; });
  for (const mesh of json.meshes) for (const primitive of mesh.primitives) delete primitive.material;
  return { json, text: JSON.stringify(json) };
}

async function record(url, fps, pick) {
  const { json, text } = plain(url);
  const gltf = await new GLTFLoader().parseAsync(text, '');
  const meshes = [];
  gltf.scene.traverse((object) => {
    if (!object.isMesh) return;
    // A mesh of several primitives is a group of them, and the group is the node.
    let owner = object;
    while (owner.userData.node === undefined) owner = owner.parent;
    meshes.push({ object, node: owner.userData.node });
  });
  meshes.sort((a, b) => a.node - b.node); // primitives stay in their order
  const frame = (time) => {
    gltf.scene.updateMatrixWorld(true);
    const bodies = {};
    for (const { object, node } of meshes) {
      object.skeleton?.update();
      const count = object.geometry.attributes.position.count;
      const places = (bodies[node] ??= []);
      for (const at of pick ?? Array.from({ length: count }, (_, at) => at)) {
        const point = new Vector3();
        object.getVertexPosition(at, point).applyMatrix4(object.matrixWorld);
        places.push(point.toArray().map((x) => Number(x.toPrecision(10))));
      }
    }
    return { time, bodies };
  };
  const clips = gltf.animations.map((clip) => {
    const mixer = new AnimationMixer(gltf.scene);
    const action = mixer.clipAction(clip).setLoop(LoopOnce);
    action.clampWhenFinished = true;
    const frames = [];
    const steps = Math.ceil(clip.duration * fps - 1e-3);
    for (let step = 0; step <= steps; step++) {
      const time = step < steps ? step / fps : clip.duration;
      action.reset().play();
      mixer.setTime(time);
      frames.push(frame(time));
    }
    mixer.stopAllAction(); // brings back what the clip moved
    return { clip: clip.name, frames };
  });
  if (clips.length === 0) clips.push({ clip: null, frames: [frame(0)] });
  const names = Object.fromEntries(meshes.map(({ node }) => [node, json.nodes[node].name ?? null]));
  return { three: REVISION, fps, ...(pick && { vertices: pick }), names, clips };
}

const write = (name, result) => writeFileSync(new URL(name, folder), JSON.stringify(result).replaceAll('{"time"', '\n{"time"') + '\n');
for (const name of ['hierarchy.gltf', 'skin.gltf', 'morph.gltf', 'skin-and-morph.gltf', 'kinds.glb']) {
  write(name.replace(/\.gl..?$/, '.json'), await record(new URL(name, folder), 8));
}
const fox = new URL('../../../../../shared/data/fox.glb', import.meta.url);
if (existsSync(fox)) {
  write('fox.json', await record(fox, 5, [0, 7, 100, 333, 576, 801, 1000, 1234, 1500, 1727]));
} else {
  console.log('skipped: there is no fox.glb beside the checkout');
}
