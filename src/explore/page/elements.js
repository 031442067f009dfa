// elements.js: makes elements of the page.

// make("label", {class: "name", for: "id"}, "text", element, ...): attributes that are null or false are left out,
// true ones are empty; names that begin with "on" are listeners.
export function make(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (key.startsWith("on"))
            element.addEventListener(key.slice(2), value);
        else if (value !== null && value !== undefined && value !== false)
            element.setAttribute(key, value === true ? "" : value);
    }
    element.append(...children.filter((child) => child !== null));
    return element;
}

// A choice from [value, text] pairs, of which the present one stays chosen where it is still there.
export function fillSelect(select, pairs) {
    const old = select.value;
    select.replaceChildren(...pairs.map(([value, text]) => make("option", {value}, text)));
    if (pairs.some(([value]) => value === old))
        select.value = old;
}
