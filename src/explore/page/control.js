// control.js: one setting as the control that its table describes: a number with a slider, a checkbox, a choice, or a
// text; with its help and range, a mark where it differs from the default, and a button that takes it back.

import {make} from "./elements.js";
import {sliderOf} from "./numbers.js";

let serial = 0; // of elements' ids

// What it is for, which values it takes, and the default.
function helpText(row) {
    const is_plain = row.type === "boolean" || row.type === "choice"; // the control shows its values
    const usual = row.default ? `default ${row.default}${row.by_quality ? ", by quality" : ""}` : "";
    const domain = [is_plain ? "" : row.domain, usual].filter(Boolean).join("; ");
    return [row.help, domain].filter(Boolean).join(" · ");
}

// Words that may stand for a number, such as "auto".
function makeWords(row, id) {
    if (!row.choices)
        return null;
    return make("datalist", {id: `${id}-words`}, ...row.choices.map((word) => make("option", {value: word})));
}

// The parts that differ by type: {elements, show(text)}; commit(text) is called with a new value.
function makeInputs(row, id, help, commit) {
    const common = {id, "aria-describedby": help, autocomplete: "off", spellcheck: "false"};
    if (row.type === "boolean") {
        const box = make("input", {...common, type: "checkbox", onchange: () => commit(box.checked ? "yes" : "no")});
        return {elements: [box], main: box, show: (text) => { box.checked = ["yes", "true", "on"].includes(text); }};
    }
    if (row.type === "choice" && row.choices) {
        const select = make("select", {...common, onchange: () => commit(select.value)},
            ...row.choices.map((choice) => make("option", {value: choice}, choice)));
        return {elements: [select], main: select, show: (text) => { select.value = text; }};
    }
    const is_number = row.type === "integer" || row.type === "number", words = makeWords(row, id);
    const field = make("input", {...common, class: is_number ? "number" : "text", type: "text",
        list: words ? words.id : null, placeholder: row.placeholder,
        onchange: () => commit(field.value.trim())});
    const slider = is_number ? sliderOf(row) : null;
    if (!slider)
        return {elements: [field, words], main: field, show: (text) => { field.value = text; }};
    const range = make("input", {type: "range", min: 0, max: 1, step: "any", "aria-label": `${row.name}, slider`,
        oninput: () => {
            field.value = String(slider.value(Number(range.value)));
            range.setAttribute("aria-valuetext", field.value);
            commit(field.value);
        },
        // A step is 1 % of the way, but a whole number at least.
        onkeydown: (event) => {
            const way = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key];
            if (!way)
                return;
            event.preventDefault();
            const now = Number(field.value), moved = slider.value(slider.position(now) + way * 0.01);
            const next = row.type === "integer" && moved === now ? now + way : moved;
            range.value = slider.position(next);
            range.dispatchEvent(new Event("input"));
        }});
    return {
        elements: [range, field, words], main: field,
        show: (text) => {
            const number = Number(text); // a word has no place on the slider
            field.value = text;
            range.value = Number.isFinite(number) ? slider.position(number) : 0;
            range.setAttribute("aria-valuetext", text);
        },
    };
}

// commit(text) when the user sets it, commit(null) when the default is to apply again.
export class Control {
    constructor(row, commit) {
        const id = `control-${++serial}`;
        const {elements, main, show} = makeInputs(row, id, `${id}-help`, (text) => {
            commit(text === "" ? null : text);
        });
        this.row = row;
        this.main = main;
        this.inputs = elements.filter(Boolean);
        this.showText = show;
        this.text = undefined;
        this.reset = make("button", {type: "button", class: "reset", title: `${row.name}: as it was at first`,
            "aria-label": `reset ${row.name}`, onclick: () => commit(null)}, "↺");
        this.error = make("p", {class: "error", role: "alert", hidden: true});
        this.root = make("div", {class: `control ${row.type}`, "data-name": row.name},
            make("label", {for: id}, row.label || row.name),
            make("span", {class: "inputs"}, ...this.inputs), this.reset,
            make("p", {class: "help", id: `${id}-help`}, helpText(row)), this.error);
    }

    // The value, and whether it is stated among the options. What the user is about to type is left alone, and so is
    // what was refused, as long as that is told.
    show(value, is_stated) {
        const text = value ?? "";
        if (!this.error.hidden)
            return;
        this.root.classList.toggle("changed", Boolean(this.row.default) && text !== this.row.default);
        this.reset.hidden = !is_stated;
        const is_new = text !== this.text;
        this.text = text;
        if (is_new || !this.inputs.includes(document.activeElement))
            this.showText(text);
    }

    // A refusal, or null.
    fail(message) {
        this.error.hidden = !message;
        this.error.textContent = message || "";
        if (message)
            this.main.setAttribute("aria-invalid", "true");
        else
            this.main.removeAttribute("aria-invalid");
    }
}
