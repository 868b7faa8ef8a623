// web/lecture/words.js: what the page itself says, in both languages.
const WORDS = {
  en: {
    reset: "Reset", sliders: "what can be moved", failed: "no live image", outside: "the camera from outside", step: "One pixel", row: "One row", play: "Play", again: "From the start",
    link: "Link to this figure", copied: "The address is copied", present: "Presenter's view", leave: "Back to the page", figure: (i, n) => `Figure ${i} of ${n}`, next: "Next figure", before: "Previous figure",
    keys: "Arrow keys: figures. Escape: back", still: "The printed figure: this browser shows no live one",
  },
  it: {
    reset: "Ripristina", sliders: "che cosa si può muovere", failed: "immagine interattiva non disponibile", outside: "la camera vista da fuori", step: "Un pixel", row: "Una riga", play: "Avvia", again: "Da capo",
    link: "Collegamento a questa figura", copied: "Indirizzo copiato", present: "Visualizzazione relatore", leave: "Torna alla pagina", figure: (i, n) => `Figura ${i} di ${n}`, next: "Figura successiva", before: "Figura precedente",
    keys: "Frecce: cambia figura. Esc: torna alla pagina", still: "La figura stampata: questo browser non mostra quella interattiva",
  },
};

const CHOICES = {
  en: { kind: "projectors", perspective: "perspective", orthographic: "orthographic", points: "vanishing points", one: "one", two: "two", three: "three", pose: "pose", general: "general", down: "looking down",
        sampler: "sampler", regular: "regular", random: "random", jittered: "jittered", columns: "columns", "<": "c < hres", "<=": "c <= hres", third: "third component", "-d": "−d", zw: "zw" },
  it: { kind: "proiezione", perspective: "prospettica", orthographic: "ortografica", points: "punti di fuga", one: "uno", two: "due", three: "tre", pose: "posa", general: "generale", down: "sguardo in giù",
        sampler: "sampler", regular: "regolare", random: "casuale", jittered: "jittered", columns: "colonne", "<": "c < hres", "<=": "c <= hres", third: "terza componente", "-d": "−d", zw: "zw" },
};

const SLIDERS = {
  en: { angle: "rotation", turn: "turn", shift_x: "shift x", shift_y: "shift y", theta: "θ", alpha: "α", hole: "hole", height: "edge", slope: "slope", up_angle: "up tilted", exposure_time: "exposure_time", fov: "fov",
        azimuth: "azimuth", elevation: "elevation", pixel: "pixel" },
  it: { angle: "rotazione", turn: "rotazione", shift_x: "spostamento x", shift_y: "spostamento y", theta: "θ", alpha: "α", hole: "foro", height: "altezza", slope: "pendenza", up_angle: "up inclinato", exposure_time: "exposure_time", fov: "fov",
        azimuth: "azimut", elevation: "elevazione", pixel: "pixel" },
};

export const words = (language) => WORDS[language] ?? WORDS.en;
export const choiceNames = (language) => CHOICES[language] ?? CHOICES.en;
export const sayIn = (language) => (en, it) => (language === "it" ? it : en);
export const sliderName = (name, language) => (SLIDERS[language] ?? SLIDERS.en)[name] ?? (/^(eye|lookat)_/.test(name) ? name.replace("_", " ") : name);
