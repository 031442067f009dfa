// options.js: the options of a view, as they are on a command line, and changes of them.
//
// A list of [name, value]. `plugin` ("estimator=gather:samples=4,paths=2") and `param` ("lamp=3") may come several
// times, of other options the last counts.

// Parts between commas; those inside of brackets belong to vectors.
function splitParameters(text) {
    const parts = [];
    let depth = 0, start = 0;
    for (let i = 0; i <= text.length; i++) {
        depth += text[i] === "[" ? 1 : text[i] === "]" ? -1 : 0;
        if (i === text.length || (text[i] === "," && depth === 0)) {
            if (i > start)
                parts.push(text.slice(start, i));
            start = i + 1;
        }
    }
    return parts;
}

function splitOnce(text, separator) {
    const at = text.indexOf(separator);
    return at < 0 ? [text, ""] : [text.slice(0, at), text.slice(at + 1)];
}

function readPlugin(value) {
    const [kind, rest] = splitOnce(value, "=");
    const [name, parameters] = splitOnce(rest, ":");
    return {kind, name, parameters: new Map(splitParameters(parameters).map((part) => splitOnce(part, "=")))};
}

// The choice of a strategy that options state: {kind, name, parameters: Map}, or null.
export function statedPlugin(options, kind) {
    let found = null;
    for (const [name, value] of options) {
        const plugin = name === "plugin" ? readPlugin(value) : null;
        if (!plugin || plugin.kind !== kind)
            continue;
        if (found && found.name === plugin.name)
            found.parameters.forEach((old, key) => plugin.parameters.has(key) || plugin.parameters.set(key, old));
        found = plugin;
    }
    return found;
}

// In the place of what it replaces, or at the end; null leaves it out.
function replaced(options, isOld, made) {
    const at = options.findIndex(isOld);
    const kept = options.filter((option) => !isOld(option));
    if (made)
        kept.splice(at < 0 ? kept.length : Math.min(at, kept.length), 0, made);
    return kept;
}

// The options with another choice of `kind`; name null: none is stated.
export function withPlugin(options, kind, name, parameters = new Map()) {
    const texts = [...parameters].map(([key, value]) => `${key}=${value}`);
    const value = `${kind}=${name}${texts.length ? ":" : ""}${texts.join(",")}`;
    return replaced(options, ([option, text]) => option === "plugin" && readPlugin(text).kind === kind,
        name === null ? null : ["plugin", value]);
}

// Likewise with another value of a parameter of the strategy `name`; value null: none is stated.
export function withParameter(options, kind, name, key, value) {
    const stated = statedPlugin(options, kind);
    const parameters = stated && stated.name === name ? stated.parameters : new Map();
    parameters.delete(key);
    if (value !== null)
        parameters.set(key, value);
    if (parameters.size === 0 && !stated)
        return options;
    return withPlugin(options, kind, name, parameters);
}

export function statedOption(options, name) {
    const found = options.filter(([option]) => option === name).pop();
    return found ? found[1] : null;
}

export function withOption(options, name, value) {
    return replaced(options, ([option]) => option === name, value === null ? null : [name, value]);
}

// Assignments, NAME=VALUE: of `param`, to a parameter of the scene, and of `set`, to a value in its text.
function isAssignment(option, name, [other, text]) {
    return other === option && splitOnce(text, "=")[0] === name;
}

export function statedAssignment(options, option, name) {
    const found = options.filter((stated) => isAssignment(option, name, stated)).pop();
    return found ? splitOnce(found[1], "=")[1] : null;
}

export function withAssignment(options, option, name, value) {
    return replaced(options, (stated) => isAssignment(option, name, stated),
        value === null ? null : [option, `${name}=${value}`]);
}
