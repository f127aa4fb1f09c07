import "uplot/dist/uPlot.min.css";
import "./styles/tokens.css";
import "./styles/base.css";
import "./styles/controls.css";

import { mount } from "svelte";
import App from "./App.svelte";
import { makeLasting } from "./state/stores";

const target = document.getElementById("app");
if (!target) throw new Error("index.html has no #app");
const lasting = makeLasting();
void lasting.identity.check();
mount(App, { target, props: { lasting } });
