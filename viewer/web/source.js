// The content of the page: served by `simwright view`, or embedded in the page itself.

async function get(path) {
  const response = await fetch(path);
  if (response.ok) return response;
  let fault = `${response.status}`;
  try {
    fault = (await response.json()).error;
  } catch { /* The status alone is known. */ }
  throw Object.assign(new Error(fault), { status: response.status });
}

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

class ServedSource {
  async open() {
    this.manifest = await (await get('/manifest')).json();
    this.buffers = new Map();
  }

  get live() { return true; }

  // Returns {bytes, type} of a buffer.
  buffer(index) {
    if (!this.buffers.has(index)) {
      this.buffers.set(index, get(`/buffer/${this.manifest.version}/${index}`).then(
        async (response) => ({
          bytes: new Uint8Array(await response.arrayBuffer()),
          type: response.headers.get('Content-Type'),
        })));
    }
    return this.buffers.get(index);
  }

  async bodies(world) {
    return this.manifest.worlds[world].bodies ??
      await (await get(`/world/${this.manifest.version}/${world}`)).json();
  }

  async replay(world) {
    const timeline = await (await get(`/replay/${this.manifest.version}/${world}`)).json();
    timeline.rows = rowsOf(bytesOf(timeline.base64));
    delete timeline.base64;
    return timeline;
  }

  async charts() { return (await get('/charts')).json(); }
  async version() { return (await get('/version')).json(); }
}

class EmbeddedSource {
  async open() {
    this.manifest = JSON.parse(document.getElementById('manifest').textContent);
    const text = document.getElementById('buffers');
    this.bytes = bytesOf(text.textContent);
    text.remove();
  }

  get live() { return false; }

  async buffer(index) {
    const { begin, size, type } = this.manifest.buffers[index];
    return { bytes: this.bytes.subarray(begin, begin + size), type };
  }

  async bodies(world) { return this.manifest.worlds[world].bodies; }
  async replay() { throw new Error('the page has no further replay'); }
  async charts() { return this.manifest.charts; }
}

// Returns little-endian bytes as numbers.
export function rowsOf(bytes) {
  const copy = bytes.slice();
  return new Float32Array(copy.buffer, 0, copy.byteLength >> 2);
}

// Opens the content. The result has `manifest`, and reads the rest when it is asked for it.
export async function openSource() {
  const source = document.getElementById('manifest') ? new EmbeddedSource() : new ServedSource();
  await source.open();
  return source;
}
