// Files: cases and surfaces that the user opens, and what is copied or downloaded.

import { fileOf, posting } from "/static/server.js";

const LONGEST = 100; // of a name

const by = (id) => document.getElementById(id);

// `page`: {current(), replace(name, tables, source), dropped(design, files), say(words)}.
export async function opened(files, page) {
  const surfaces = [...files].filter((one) => !isCase(one));
  for (const file of files) {
    try {
      if (isCase(file)) await openedCase(file, page);
      else await openedSurface(file, surfaces.length > 1, page);
    } catch (error) {
      page.say(`${file.name}: ${error.message}`);
    }
  }
}

const isCase = (file) => file.name.toLowerCase().endsWith(".toml");

async function openedCase(file, page) {
  if (file.size > 1 << 20) throw new Error("a case must be at most 1 MiB");
  const { tables } = await posting("/api/read", await file.text(), "text/plain");
  page.replace(file.name.replace(/\.toml$/i, "").slice(0, LONGEST), tables, file.name.slice(0, LONGEST));
  page.say(`${file.name} is open.`);
}

async function openedSurface(file, together, page) {
  page.say(`${file.name} is being read.`);
  const design = page.current();
  const { name, token } = await posting(`/api/surfaces/${encodeURIComponent(file.name)}`, file, "application/octet-stream");
  const files = design.get("roughness", "files") ?? [];
  const before = together ? files.filter((one) => design.surfaces[one] && one !== name) : [];
  design.surfaces = { ...design.surfaces, [name]: token };
  page.dropped(design, files.includes(name) ? files : [...before, name].slice(-2)); // it may be one that the case asked for
  page.say(`${name} is the surface now.`);
}

export async function copyCase(design, say) {
  const { toml } = await posting("/api/toml", JSON.stringify(design.question()));
  by("text-content").value = toml;
  by("text").showModal();
  by("text-content").select();
  say((await copied(toml)) ? "The case is copied." : "Copy the text from the box.");
}

export async function copied(words) {
  try {
    await navigator.clipboard.writeText(words);
    return true;
  } catch {
    return false;
  }
}

export async function download(name, design, say) {
  say(`${name} is being made.`);
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(await fileOf(name, design.question())), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  say(`${name} is downloaded.`);
}
