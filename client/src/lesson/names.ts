/** How trainees may be called: what `trocar.records.names` takes, checked as soon as a name is given. */

const LONGEST = 80; // characters
const UNSEEN = /[\p{C}\p{Zl}\p{Zp}]|(?! )\p{Zs}/u; // control, formatting and other characters that nobody sees
const SCRIPTED: readonly string[] = ["scripted expert", "scripted novice"]; // programs that do tasks

/** Return a name as the records keep it. */
export function asKept(text: string): string {
  return text.normalize("NFC").trim();
}

/** Return what is wrong with a name, as a sentence for who gave it; empty if nothing is. */
export function troubleWith(text: string): string {
  const name = asKept(text);
  if (!name) return "Write your name: it takes a letter at least.";
  if ([...name].length > LONGEST) return `Write a shorter name, of ${LONGEST} characters at most.`;
  if (UNSEEN.test(name)) return "There are characters in this name that nobody can see. Write it anew, with letters and spaces.";
  const read = name.normalize("NFKC").toLowerCase().split(/\s+/u).join(" ");
  if (SCRIPTED.includes(read)) return "A program of the trainer is called so. Write your own name.";
  return "";
}
