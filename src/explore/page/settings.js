// settings.js: the settings of one view: all strategies with their parameters, options of the render, cameras and
// parameters of the scene. The server's state says what they are; what the user changes goes to it at once.

import {Control} from "./control.js";
import {make} from "./elements.js";
import * as options from "./options.js";

const delay = 150; // ms in which changes of a slider become one

// Estimators first: they are the methods, and the others are their parts.
function inOrder(kinds) {
    return [...kinds].sort((a, b) => (b.kind === "estimator") - (a.kind === "estimator"));
}

// A menu of one kind's strategies, and the parameters of the one that is chosen.
class Strategy {
    constructor(kind, change) {
        this.kind = kind;
        this.change = change;
        this.name = null;
        this.controls = [];
        this.menu = new Control({name: kind.kind, type: "choice", help: kind.help,
            choices: kind.plugins.map((plugin) => plugin.name)},
            (name) => change((list) => options.withPlugin(list, kind.kind, name), this.menu));
        this.title = make("p", {class: "help title"});
        this.parameters = make("div", {class: "parameters"});
        this.root = make("section", {class: "strategy", "data-kind": kind.kind}, this.menu.root, this.title,
            this.parameters);
    }

    // The controls of a strategy that is newly chosen; experts' ones are folded away.
    build(name) {
        this.name = name;
        const plugin = this.kind.plugins.find((candidate) => candidate.name === name);
        this.title.textContent = plugin ? [plugin.title, plugin.paper].filter(Boolean).join(" · ") : "";
        this.controls = (plugin ? plugin.parameters : []).map((row) => {
            const control = new Control(row, (text) => this.change(
                (list) => options.withParameter(list, this.kind.kind, name, row.name, text), control));
            return control;
        });
        const of = (is_expert) => this.controls.filter(({row}) => Boolean(row.expert) === is_expert);
        this.parameters.replaceChildren(...of(false).map(({root}) => root));
        if (of(true).length > 0)
            this.parameters.append(experts(of(true)));
    }

    show(list, view) {
        const stated = options.statedPlugin(list, this.kind.kind);
        const name = stated ? stated.name : view.strategies[this.kind.kind] || "";
        if (name !== this.name)
            this.build(name);
        this.menu.show(name, Boolean(stated));
        for (const control of this.controls) {
            const text = stated?.parameters.get(control.row.name);
            // What the scene's file says counts for the strategy that it names.
            const of_scene = view.strategies[this.kind.kind] === name && view.parameters[this.kind.kind];
            control.show(text ?? of_scene?.[control.row.name] ?? control.row.default, text !== undefined);
        }
    }
}

// A control of anything else, with how the options state it, and its value where they don't.
function simpleControl(row, change, stated, changed, usual) {
    const control = new Control(row, (text) => change((list) => changed(list, text), control));
    return {
        root: control.root,
        show(list, view) {
            const text = stated(list);
            control.show(text ?? usual(view), text !== null);
        },
    };
}

function optionControl(row, change) {
    const placeholder = row.name === "size" ? row.domain : null;
    return simpleControl({...row, placeholder}, change, (list) => options.statedOption(list, row.name),
        (list, text) => options.withOption(list, row.name, text), (view) => view.values[row.name] ?? row.default);
}

// Values of the scene's text that no option of their own sets.
function setControl(row, change) {
    const label = row.name.slice(row.name.indexOf(".") + 1);
    return simpleControl({...row, label}, change, (list) => options.statedAssignment(list, "set", row.name),
        (list, text) => options.withAssignment(list, "set", row.name, text),
        (view) => view.values[row.name] ?? row.default);
}

function parameterControl(row, change) {
    return simpleControl({...row, default: row.value}, change,
        (list) => options.statedAssignment(list, "param", row.name),
        (list, text) => options.withAssignment(list, "param", row.name, text), () => row.value);
}

function experts(controls) {
    return make("details", {}, make("summary", {}, `for experts (${controls.length})`),
        ...controls.map(({root}) => root));
}

function group(title, is_open, parts) {
    return make("details", {class: "group", open: is_open}, make("summary", {}, title),
        ...parts.map((part) => part.root));
}

export class Settings {
    // send(list, passes) is a promise that fails with a Refused.
    constructor(root, send) {
        this.root = root;
        this.send = send;
        this.view = null;
        this.wanted = null; // what was asked for, until the state has it: {list, passes, control}
        this.timer = null;
        this.sent = Promise.resolve(); // all that was sent, one after the other
        this.parts = [];
        this.failed = null;
    }

    // From the catalogue, once, and whenever a saved scene brings other parameters.
    build(catalogue) {
        const change = (edited, control) => this.change(edited, control);
        const strategies = inOrder(catalogue.kinds).map((kind) => new Strategy(kind, change));
        const of = (display) => strategies.filter(({kind}) => Boolean(kind.display) === display);
        const render = [...catalogue.options.map((row) => optionControl(row, change)), this.passesControl()];
        const sets = catalogue.sets.map((row) => setControl(row, change));
        const scene = catalogue.parameters.map((row) => parameterControl(row, change));
        if (catalogue.cameras.length > 1)
            scene.unshift(optionControl({name: "camera", type: "choice", choices: catalogue.cameras,
                help: "through which of the scene's cameras"}, change));
        this.parts = [...strategies, ...render, ...sets, ...scene];
        this.root.replaceChildren(
            group("Method", true, of(false).filter(({kind}) => kind.kind === "estimator")),
            ...scene.length > 0 ? [group("Scene", true, scene)] : [],
            group("Render", true, [...render, {root: experts(sets)}]),
            group("Parts of the method", true, of(false).filter(({kind}) => kind.kind !== "estimator")),
            group("Display", false, of(true)));
        if (this.view)
            this.show(this.view);
    }

    passesControl() {
        const control = new Control({name: "passes", type: "integer", minimum: 1, maximum: 65536, default: "64",
            domain: "integer 1..65536", help: "the picture refines until so many are done"},
            (text) => this.ask({list: this.list(), passes: Number(text ?? 64), control}));
        return {root: control.root, show: (list, view) => {
            const wanted = String(this.wanted?.passes ?? view.passes_wanted);
            control.show(wanted, wanted !== "64");
        }};
    }

    list() {
        return this.wanted ? this.wanted.list : this.view.options;
    }

    // A new state of the view. What was asked for and not yet sent stays on top of it.
    show(view) {
        this.view = view;
        for (const part of this.parts)
            part.show(this.list(), view);
    }

    // Another view's settings: what was asked for of the old one is sent, errors are gone.
    turnTo(send, view) {
        if (this.timer !== null)
            this.sendNow();
        this.wanted = null;
        this.send = send;
        this.fail(null, null);
        this.show(view);
    }

    // edited(list) is the list of options with the change that the control stands for.
    change(edited, control) {
        this.ask({list: edited(this.list()), passes: this.wanted?.passes ?? this.view.passes_wanted, control});
    }

    resetAll() {
        this.ask({list: [], passes: this.view.passes_wanted, control: null});
    }

    ask(wanted) {
        this.wanted = wanted;
        this.show(this.view);
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.sendNow(), delay);
    }

    // What is asked for and not yet sent is forgotten: its view is gone.
    drop() {
        clearTimeout(this.timer);
        this.timer = null;
        this.wanted = null;
    }

    sendNow() {
        const wanted = this.wanted, send = this.send;
        clearTimeout(this.timer);
        this.timer = null;
        this.sent = this.sent.then(() => this.sendOne(send, wanted));
    }

    // Requests that overtake each other would leave an older list; so each waits for the one before, and what a newer list
    // of the same view holds as well is left out.
    async sendOne(send, wanted) {
        if (this.send === send && this.wanted && this.wanted !== wanted && this.timer === null)
            return;
        try {
            await send(wanted.list, wanted.passes);
            if (this.wanted !== wanted)
                return; // changed meanwhile
            this.view = {...this.view, options: wanted.list, passes_wanted: wanted.passes};
            this.wanted = null;
            this.fail(null, null);
        } catch (refusal) {
            if (this.wanted === wanted)
                this.fail(wanted.control, refusal.message);
        }
    }

    // What is refused is not asked for again: the next change starts from what the program has.
    fail(control, message) {
        this.failed?.fail(null);
        this.failed = control;
        control?.fail(message);
        if (control)
            this.wanted = null;
    }
}
