// Which case is shown: a built-in one by its name, or what it was before it was changed.

export class CaseBox {
  // `cases`: names of the built-in ones, and of the one that the server began with.
  constructor(select, cases) {
    this.select = select;
    this.cases = cases;
    this.here = new Option("", "");
    this.here.hidden = true;
    select.append(this.here, ...cases.map((name) => new Option(name, name)));
  }

  has(name) {
    return this.cases.includes(name);
  }

  show(design) {
    const own = design.changed || !this.has(design.source);
    this.here.hidden = !own;
    this.here.textContent = own ? called(design, this.has(design.source)) : "";
    this.select.value = own ? "" : design.source;
  }
}

// E.g. "glass-bead, changed" or "wet-drop.toml (from the link)".
function called({ source, changed, linked }, known) {
  return `${source}${changed ? ", changed" : ""}${linked && !known ? " (from the link)" : ""}`;
}
