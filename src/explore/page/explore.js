// explore.js: the page of `psplat explore`. The program holds the state of the views, which all pages share; each page
// has a look of its own, kept in its address, so that a reload shows the same.

import {takesExposure} from "./colour.js";
import {Comparison} from "./comparison.js";
import {fillSelect} from "./elements.js";
import {Light} from "./light.js";
import {short} from "./numbers.js";
import {Panes} from "./panes.js";
import {Probe} from "./probe.js";
import * as server from "./server.js";
import {Settings} from "./settings.js";

const look = {layer: "display", exposure: 0, mode: "side", split: 0.5, edited: "a", measure: false};
const by_id = (id) => document.getElementById(id);
let state = null, catalogue_text = "", is_lost = false;
let turns_to_b = false; // to its settings, once the state has the view that was asked for
let refusal = null; // of what has no control of its own: {heading, message, causes}

// --- the look of this page -----------------------------------------------------------------------------------

function readLook() {
    const stored = new URLSearchParams(location.hash.slice(1));
    look.layer = stored.get("layer") || look.layer;
    look.exposure = Math.min(Math.max(Number(stored.get("exposure")) || 0, -8), 8);
    look.mode = stored.get("mode") || look.mode;
    look.measure = stored.get("errors") === "1";
}

let store_timer = null;

function storeLook() {
    clearTimeout(store_timer); // browsers refuse hundreds of changes a second
    store_timer = setTimeout(() => {
        const parts = new URLSearchParams({layer: look.layer, exposure: look.exposure, mode: look.mode,
            errors: look.measure ? 1 : 0});
        history.replaceState(null, "", `#${parts}`);
    }, 300);
}

function changeLook(change) {
    Object.assign(look, change);
    storeLook();
    if (state)
        showState(state);
}

// --- parts ----------------------------------------------------------------------------------------------------

const panes = new Panes(look, (what) => {
    if (what === "split") {
        by_id("split").value = look.split;
        panes.draw();
    }
    if (what === "pick")
        probePointer();
    showValues();
    showZoom();
});
const probe = new Probe({root: by_id("probe"), title: by_id("probe-title"), table: by_id("probe-values"),
    note: by_id("probe-note")});
const light = new Light(() => {
    by_id("probe-light-text").textContent = light.text;
    panes.viewports.a.draw();
});
panes.viewports.a.overlay = (context, at) => light.draw("a", context, at, () => panes.frame());
const settings = new Settings(by_id("controls"), sendTo("a"));
const comparison = new Comparison(Object.fromEntries(["metrics", "metrics_caption", "metrics_empty", "plot",
    "plot_empty", "plot_legend", "reference_form", "reference_kind", "reference_file", "reference_samples",
    "reference_state", "reference_error", "reference_drop"].map((name) => [name, by_id(name.replaceAll("_", "-"))])));

function sendTo(view) {
    return (options, passes) => server.put(`view/${view}`, {options, passes});
}

// --- what is shown ----------------------------------------------------------------------------------------------

function showValues() {
    const found = panes.values();
    by_id("at").textContent = found ? `x ${found.x} y ${found.y}` : "point at a pixel";
    for (const view of ["a", "b"]) {
        const name = state?.views.b ? view.toUpperCase() : look.layer;
        const texts = found?.[view]?.map((value) => short(value, 4).padStart(9));
        by_id(`value-${view}`).textContent = texts ? [name, ...texts].join(" ") : "";
    }
}

function showZoom() {
    if (state)
        by_id("zoom").textContent = `${short(100 * panes.zoom(), 3)} %`;
}

function showLegend() {
    const legend = panes.legend();
    by_id("legend").hidden = !legend;
    if (!legend)
        return;
    by_id("legend-text").textContent = legend.text;
    by_id("legend-low").textContent = legend.low ?? "";
    by_id("legend-high").textContent = legend.high ?? "";
    by_id("legend-ramp").hidden = !legend.table;
    if (!legend.table)
        return;
    const context = by_id("legend-ramp").getContext("2d"), image = context.createImageData(256, 1);
    for (let i = 0; i < 256; i++)
        image.data.set([...legend.table.subarray(3 * i, 3 * i + 3), 255], 4 * i);
    context.putImageData(image, 0, 0);
}

// What is wrong: a heading and the message, or null.
function problemOf() {
    if (is_lost)
        return ["The program does not answer.", "It has ended: start it again, and open the address that it prints. " +
            "The command line below has the settings."];
    if (refusal)
        return [refusal.heading, refusal.message];
    if (state.scene_error) {
        // An error of an option has no file: the scene is another, and has no such parameter or camera any more.
        return withPlace(state.scene_error.file ? "The scene has an error; the picture is from before." :
            "The scene does not take the options; the picture is from before.", state.scene_error);
    }
    for (const view of ["a", "b"]) {
        if (state.views[view]?.error)
            return withPlace(`View ${view.toUpperCase()} can't be rendered.`, state.views[view].error);
    }
    return null;
}

// What a refusal depends on: it is told until that is other.
function causes() {
    return JSON.stringify([state.catalogue, state.views.a.options]);
}

function refuse(heading, message) {
    refusal = {heading, message, causes: causes()};
    showProblem();
}

function forgive() {
    if (refusal?.causes !== causes())
        refusal = null;
}

function withPlace(heading, {message, file, line, column}) {
    const place = [file, line, column].filter(Boolean).join(":");
    return [`${heading} ${place}`, message];
}

function showProblem() {
    const problem = problemOf();
    by_id("problem").hidden = !problem;
    if (problem) {
        by_id("problem-title").textContent = problem[0];
        by_id("problem-text").textContent = problem[1];
    }
}

// Those of both views, in their order.
function showLayers() {
    const views = Object.values(state.views).filter(Boolean);
    const preview = views.some((view) => view.preview);
    const names = [...new Set(views.flatMap(({layers}) => layers.map(({name}) => name)))];
    const select = by_id("layer");
    const listed = Array.from(select.options, (option) => option.value);
    // A preview may have fewer layers than what follows it.
    if (names.length > 0 && names.join() !== listed.join() && !(preview && listed.length > 0))
        fillSelect(select, names.map((name) => [name, name]));
    if (names.length > 0 && !names.includes(look.layer) && !preview)
        look.layer = names.includes("display") ? "display" : names[0];
    select.value = look.layer;
    const is_light = takesExposure(look.layer) || panes.mode() === "difference";
    by_id("exposure").disabled = !is_light;
    by_id("exposure-label").title = is_light ? "in stops: a factor of 2 each" :
        "light alone has an exposure: choose another layer, such as picture";
    by_id("exposure").value = look.exposure;
    by_id("exposure-value").textContent = look.exposure > 0 ? `+${look.exposure}` : String(look.exposure);
}

function showCompared() {
    const has_two = Boolean(state.views.b);
    by_id("compare").setAttribute("aria-pressed", String(has_two));
    const modes = panes.modes(), select = by_id("mode");
    by_id("mode-label").hidden = modes.length < 2;
    if (select.dataset.modes !== modes.join()) {
        fillSelect(select, modes);
        select.dataset.modes = modes.join();
    }
    select.value = panes.mode();
    by_id("split-label").hidden = panes.mode() !== "slider";
    by_id("edited").hidden = !has_two;
    by_id("measure").setAttribute("aria-pressed", String(look.measure));
    by_id("comparison").hidden = !look.measure;
    document.body.classList.toggle("two", has_two);
    document.body.classList.toggle("measures", look.measure);
}

function showSettings() {
    if (look.edited === "b" && !state.views.b) {
        settings.drop();
        edit("a");
    }
    const view = state.views[look.edited];
    by_id("settings-title").textContent = state.views.b ? "settings" : "Settings";
    settings.show(view);
    by_id("command").textContent = view.command;
}

function edit(view) {
    look.edited = view;
    document.querySelector(`input[name=edited][value=${view}]`).checked = true;
    settings.turnTo(sendTo(view), state.views[view]);
    by_id("command").textContent = state.views[view].command;
}

function showState(next) {
    state = next;
    panes.state = state;
    forgive();
    showLayers();
    panes.show(state);
    showCompared();
    showLegend();
    showSettings();
    showProblem();
    showZoom();
    showValues();
    probe.show(state);
    showLight();
    if (look.measure)
        comparison.show(state, look.layer);
}

// The catalogue changes with the scene: its parameters and cameras.
async function readCatalogue() {
    const catalogue = await server.get("catalogue").catch(() => null); // the program is gone, which is told already
    const text = JSON.stringify(catalogue);
    if (!catalogue || text === catalogue_text)
        return;
    catalogue_text = text;
    by_id("scene").textContent = catalogue.scene;
    document.title = `${catalogue.scene} – psplat explore`;
    settings.build(catalogue);
}

// --- what the user does ------------------------------------------------------------------------------------------

async function toggleCompare() {
    const {a, b} = state.views;
    if (b && look.edited === "b")
        settings.drop();
    refusal = null;
    showProblem();
    try {
        turns_to_b = !b;
        await settings.sent; // a change on its way would make B anew
        await (b ? server.remove("view/b") : server.put("view/b", {options: a.options, passes: a.passes_wanted}));
    } catch (problem) {
        turns_to_b = false;
        refuse(b ? "View B stays." : "View B can't be made.", problem.message);
    }
}

// In the place of a control, where there is none to stand beside.
const reset_all = {fail: (message) => message && refuse("The settings stay as they are.", message)};

function nextOf(list, now, step) {
    return list[(list.indexOf(now) + step + list.length) % list.length];
}

function nextLayer(step) {
    const names = Array.from(by_id("layer").options, (option) => option.value);
    changeLook({layer: nextOf(names, look.layer, step)});
}

function probePointer() {
    probe.turnTo(panes.pointer);
    probe.show(state);
    showLight();
}

// Of view A, where there are two.
function showLight() {
    light.turnTo("a", probe.place, state.views.a);
}

function changeExposure(exposure) {
    if (!by_id("exposure").disabled)
        changeLook({exposure: Math.min(Math.max(exposure, -8), 8)});
}

const keys = {
    "f": () => panes.place.fit(),
    "1": () => panes.actualSize(),
    "+": () => panes.zoomBy(1.5),
    "=": () => panes.zoomBy(1.5),
    "-": () => panes.zoomBy(1 / 1.5),
    "ArrowLeft": () => panes.panBy(-60, 0),
    "ArrowRight": () => panes.panBy(60, 0),
    "ArrowUp": () => panes.panBy(0, -60),
    "ArrowDown": () => panes.panBy(0, 60),
    "[": () => changeExposure(look.exposure - 0.5),
    "]": () => changeExposure(look.exposure + 0.5),
    "0": () => changeExposure(0),
    "l": () => nextLayer(1),
    "L": () => nextLayer(-1),
    "c": toggleCompare,
    "m": () => changeLook({mode: nextOf(panes.modes().map(([value]) => value), panes.mode(), 1)}),
    "p": probePointer,
    "e": () => changeLook({measure: !look.measure}),
    "?": () => by_id("keys").showModal(),
};

// Sliders, check boxes and buttons keep the focus after they were used: of the keys they take the arrows alone.
function pressed(event) {
    const is_typing = event.target.closest("input:not([type=range], [type=checkbox], [type=radio]), select, dialog");
    if (is_typing || event.ctrlKey || event.altKey || event.metaKey || !state || !Object.hasOwn(keys, event.key))
        return;
    const scrolls = event.key.startsWith("Arrow");
    if (scrolls && event.target.closest("form, input, footer, #comparison"))
        return;
    event.preventDefault();
    keys[event.key]();
}

async function copyCommand() {
    const button = by_id("copy");
    try {
        await navigator.clipboard.writeText(by_id("command").textContent);
        button.textContent = "Copied";
    } catch {
        // No permission: it is selected, to be copied by hand.
        getSelection().selectAllChildren(by_id("command"));
        button.textContent = "Selected";
    }
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
}

function listen() {
    by_id("layer").addEventListener("change", (event) => changeLook({layer: event.target.value}));
    by_id("exposure").addEventListener("input", (event) => changeExposure(Number(event.target.value)));
    by_id("exposure").addEventListener("dblclick", () => changeExposure(0));
    by_id("mode").addEventListener("change", (event) => changeLook({mode: event.target.value}));
    by_id("split").addEventListener("input", (event) => changeLook({split: Number(event.target.value)}));
    by_id("fit").addEventListener("click", keys.f);
    by_id("actual").addEventListener("click", keys["1"]);
    by_id("zoom-in").addEventListener("click", keys["+"]);
    by_id("zoom-out").addEventListener("click", keys["-"]);
    by_id("compare").addEventListener("click", toggleCompare);
    by_id("measure").addEventListener("click", keys.e);
    by_id("help").addEventListener("click", keys["?"]);
    by_id("probe-close").addEventListener("click", () => {
        probe.turnTo(null);
        showLight();
    });
    by_id("probe-light").addEventListener("change", (event) => {
        light.wanted = event.target.checked;
        showLight();
    });
    by_id("reset-all").addEventListener("click", () => settings.resetAll(reset_all));
    by_id("copy").addEventListener("click", copyCommand);
    by_id("settings").addEventListener("submit", (event) => event.preventDefault());
    by_id("edited").addEventListener("change", (event) => edit(event.target.value));
    document.addEventListener("keydown", pressed);
    window.addEventListener("resize", showZoom);
}

async function start() {
    readLook();
    listen();
    await readCatalogue();
    let catalogue_number = null;
    server.watchState((next) => {
        showState(next);
        if (turns_to_b && next.views.b) {
            turns_to_b = false;
            edit("b");
        }
        if (catalogue_number !== null && next.catalogue !== catalogue_number)
            readCatalogue();
        catalogue_number = next.catalogue;
    }, (lost) => {
        if (lost === is_lost)
            return;
        is_lost = lost;
        if (state)
            showProblem();
        if (!lost) {
            refusal = null;
            panes.forget();
            readCatalogue();
        }
    });
}

start();
