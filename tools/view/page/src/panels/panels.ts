// SPDX-License-Identifier: MIT
import type { Actions, DocumentFacts, Facts } from '../model/actions.js';
import type { Store } from '../model/store.js';
import { makeAnswerPanel } from './answer_panel.js';
import { make, uniqueId } from './dom.js';
import { makeFilePanel } from './file_panel.js';
import { makeKeyframePanel } from './keyframe_panel.js';
import { makeOptionPanel } from './option_panel.js';
import { makeScenePanel } from './scene_panel.js';

export interface Panels {
  setFacts(facts: Facts): void;
  setDocument(facts: DocumentFacts): void;
  /** Shows a panel, for keys of the page. */
  show(name: PanelName): void;
}

export type PanelName = 'answer' | 'keyframes' | 'options' | 'scene' | 'file';

const kTitles: readonly (readonly [PanelName, string])[] = [
  ['answer', 'Answer'],
  ['keyframes', 'Keyframes'],
  ['options', 'Options'],
  ['scene', 'Scene'],
  ['file', 'File'],
];

/** Makes the panels as tabs: arrow keys go from tab to tab, Tab goes into the panel. */
export function makePanels(host: HTMLElement, store: Store, actions: Actions): Panels {
  const bar = make('div', { class: 'cw-tabs', role: 'tablist', 'aria-label': 'Panels' });
  host.classList.add('cw-panels');
  host.append(bar);
  const tabs = kTitles.map(([name, title]) => tabOf(name, title));
  for (const { tab, panel } of tabs) {
    bar.append(tab);
    host.append(panel);
  }
  const show = (name: PanelName): void => {
    for (const { tab, panel } of tabs) {
      const isShown = panel.dataset['panel'] === name;
      panel.hidden = !isShown;
      tab.setAttribute('aria-selected', String(isShown));
      tab.tabIndex = isShown ? 0 : -1;
    }
  };
  tabs.forEach(({ tab, name }, i) => {
    tab.addEventListener('click', () => show(name));
    tab.addEventListener('keydown', (event) => {
      // With Alt, arrows move what is selected.
      const next = event.altKey || event.ctrlKey || event.metaKey ? undefined : nextTab(event.key, i);
      if (next === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      show((tabs[next] as Tab).name);
      (tabs[next] as Tab).tab.focus();
    });
  });
  const panelOf = (name: PanelName): HTMLElement => (tabs.find((tab) => tab.name === name) as Tab).panel;
  show('answer');
  makeAnswerPanel(panelOf('answer'), store, actions);
  const keyframes = makeKeyframePanel(panelOf('keyframes'), store, actions);
  const options = makeOptionPanel(panelOf('options'), store, actions);
  const scene = makeScenePanel(panelOf('scene'), store, actions);
  const file = makeFilePanel(panelOf('file'), store, actions);
  return {
    setFacts(facts) {
      options.setFacts(facts);
      scene.setFacts(facts);
      file.setFacts(facts);
    },
    setDocument(facts) {
      keyframes.setDocument(facts);
      file.setDocument(facts);
    },
    show,
  };
}

interface Tab {
  name: PanelName;
  tab: HTMLButtonElement;
  panel: HTMLElement;
}

function tabOf(name: PanelName, title: string): Tab {
  const tab = make('button', { type: 'button', role: 'tab', text: title, id: uniqueId() });
  const panel = make('div', { class: 'cw-panel', role: 'tabpanel', tabindex: '0', 'aria-labelledby': tab.id, id: uniqueId(), 'data-panel': name });
  tab.setAttribute('aria-controls', panel.id);
  return { name, tab, panel };
}

function nextTab(key: string, index: number): number | undefined {
  const count = kTitles.length;
  switch (key) {
    case 'ArrowRight':
      return (index + 1) % count;
    case 'ArrowLeft':
      return (index + count - 1) % count;
    case 'Home':
      return 0;
    case 'End':
      return count - 1;
    default:
      return undefined;
  }
}
