// What the page asks of its server.

export class Refusal extends Error {
  // kind: "input", "numerics", "busy", ...; problems: all that is wrong, {key, message}, of which
  // key is the dotted key at fault, or null; remedies: {at, key, value}, null until they are known.
  constructor({ kind, key, message, problems }) {
    super(message);
    this.kind = kind;
    this.problems = problems ?? [{ key, message }];
    this.remedies = null;
  }
}

export async function getting(path) {
  return whole(await fetch(path));
}

export async function posting(path, body, kind = "application/json", signal = undefined) {
  return whole(await fetch(path, { method: "POST", headers: { "content-type": kind }, body, signal }));
}

async function whole(response) {
  if (!response.ok) throw await refusal(response);
  return response.json();
}

async function refusal(response) {
  try {
    return new Refusal((await response.json()).error);
  } catch {
    return new Refusal({ kind: "request", key: null, message: `the server answered ${response.status}` });
  }
}

// The answer to a case; `tell(fraction, text)` hears of its progress. Null where a newer one came.
export async function explored(question, signal, tell) {
  const response = await fetch("/api/explore", {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(question), signal,
  });
  if (!response.ok) throw await refusal(response);
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) throw new Refusal({ kind: "request", key: null, message: "the server has ended" });
    text += value;
    for (let end = text.indexOf("\n"); end >= 0; end = text.indexOf("\n")) {
      const line = JSON.parse(text.slice(0, end));
      text = text.slice(end + 1);
      if (line.answer) return line.answer;
      if (line.replaced) return null;
      if (line.error) throw new Refusal(line.error);
      tell(line.progress, line.text);
    }
  }
}

export async function fileOf(name, question) {
  const response = await fetch(`/api/files/${name}`, {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(question),
  });
  if (!response.ok) throw await refusal(response);
  return response.blob();
}

// Numbers that the server packed as base64 of 32-bit floats.
export function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}
