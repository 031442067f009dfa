// settings.js: the settings of one view: all strategies with their parameters, options of the render, cameras and
// parameters of the scene. The server's state says what they are; what the user changes goes to it at once.
//
// What the user does is kept as changes of whatever the program has, not as a list of options: so one that is refused
// takes no other with it, and one of another page in between stays.

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

// What one view is asked for: changes of its settings that the program has neither taken nor refused yet.
class Asked {
    // send(list, passes) is a promise that fails with a Refused.
    constructor(send, view) {
        this.send = send;
        this.view = view;
        this.changes = []; // [{edit, control}], oldest first; edit({list, passes}) is the settings with the change
    }

    settings(changes = this.changes) {
        return changes.reduce((settings, {edit}) => edit(settings),
            {list: this.view.options, passes: this.view.passes_wanted});
    }

    // Of one control, the newest counts.
    add(change) {
        this.changes = [...this.changes.filter(({control}) => control !== change.control), change];
    }

    async sendThese(changes) {
        const {list, passes} = this.settings(changes);
        await this.send(list, passes);
        this.view = {...this.view, options: list, passes_wanted: passes};
        this.changes = this.changes.filter((change) => !changes.includes(change));
    }

    // All together, as they may need each other; where that is refused, each alone, so that only what is wrong is left
    // out. refused(control, message) is told what that is.
    async sendAll(refused) {
        const changes = this.changes;
        if (changes.length > 1 && await this.sendThese(changes).then(() => true, () => false))
            return;
        for (const change of changes) {
            try {
                if (this.changes.includes(change)) // its control has had no newer one meanwhile
                    await this.sendThese([change]);
            } catch (problem) {
                if (this.changes.includes(change))
                    refused(change.control, problem.message);
                this.changes = this.changes.filter((kept) => kept !== change);
            }
        }
    }
}

export class Settings {
    // send(list, passes) is a promise that fails with a Refused.
    constructor(root, send) {
        this.root = root;
        this.asked = new Asked(send, null);
        this.timer = null;
        this.sent = Promise.resolve(); // all that was sent, one after the other
        this.parts = [];
        this.failed = []; // controls beside which a refusal stands
    }

    // From the catalogue, once, and whenever a saved scene brings other parameters.
    build(catalogue) {
        const change = (edited, control) => this.ask(
            ({list, passes}) => ({list: edited(list), passes}), control);
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
        if (this.asked.view)
            this.show(this.asked.view);
    }

    passesControl() {
        const control = new Control({name: "passes", type: "integer", minimum: 1, maximum: 65536, default: "64",
            domain: "integer 1..65536", help: "the picture refines until so many are done"}, (text) => {
            const number = Number(text ?? 64), passes = Number.isFinite(number) ? number : text; // a word is refused
            this.ask(({list}) => ({list, passes}), control);
        });
        return {root: control.root, show: () => {
            const wanted = String(this.asked.settings().passes);
            control.show(wanted, wanted !== "64");
        }};
    }

    // A new state of the view. What was asked for and not yet taken stays on top of it.
    show(view) {
        this.asked.view = view;
        const {list} = this.asked.settings();
        for (const part of this.parts)
            part.show(list, view);
    }

    // Another view's settings: what was asked for of the old one is sent, errors are gone.
    turnTo(send, view) {
        if (this.timer !== null)
            this.sendNow();
        this.asked = new Asked(send, view);
        this.forgive();
        this.show(view);
    }

    resetAll(control) {
        this.drop();
        this.ask(({passes}) => ({list: [], passes}), control);
    }

    ask(edit, control) {
        this.forgive();
        this.asked.add({edit, control});
        this.show(this.asked.view);
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.sendNow(), delay);
    }

    // What is asked for and not yet sent is forgotten: its view is gone.
    drop() {
        clearTimeout(this.timer);
        this.timer = null;
        this.asked.changes = [];
    }

    // Requests that overtake each other would leave an older list; so each waits for the one before, and takes along what
    // was asked for meanwhile.
    sendNow() {
        const asked = this.asked;
        clearTimeout(this.timer);
        this.timer = null;
        this.sent = this.sent.then(() => asked.sendAll((control, message) => {
            if (asked !== this.asked)
                return; // the controls show another view
            this.failed.push(control);
            control.fail(message);
        }));
    }

    // Refusals are told until the next change.
    forgive() {
        for (const control of this.failed)
            control.fail(null);
        this.failed = [];
    }
}
